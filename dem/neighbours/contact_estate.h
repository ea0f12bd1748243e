#pragma once
/// What a neighbour list leaves to the next one: the histories of its touching pairs, by grain, and nothing else. Taking it frees the list's own
/// histories, so old and new list never stand in memory side by side.
#include <cstdint>
#include <span>
#include <vector>

#include "dem/neighbours/raw_array.h"

namespace venato::dem {
struct PairList;

class ContactEstate {
 public:
  /// Takes the histories out of the list, whose contacts are gone afterwards.
  /// \param id [slot of the list] of its grains
  ContactEstate(PairList& list, std::span<const std::int64_t> id, int threads);

  /// Contact of two grains. \param lower, higher slots in the old list of the grains with the lower and the higher id; grains new to it have slots
  /// beyond it
  const double* history(std::size_t lower, std::size_t higher) const;
  std::size_t grain_count() const { return grains_; }

 private:
  struct Block {
    std::vector<std::uint32_t> end;     ///< [grain] of its contacts with higher ids
    std::vector<std::int32_t> partner;  ///< [contact] old slot
    RawArray<double> rows;              ///< [contact][width]
  };
  std::size_t grains_ = 0, width_ = 0;
  std::vector<Block> block_;
};
}  // namespace venato::dem
