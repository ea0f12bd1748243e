#pragma once
/// Neighbour list with the contact histories. Every pair is owned by the grain with the lower id; rows stand in the spatial order of their owners and
/// are sorted by the partner's id inside, so histories are carried from the old list to the new one by merging sorted rows.
///
/// A grain's contacts in ascending order of the partner's id (the order in which forces are summed, whatever the list) are its incoming pairs, owned by
/// partners with lower ids, then its own. Both carry one byte per pair that says whether they touch, side by side: a grain finds its touching pairs
/// without looking at the others.
#include <cstdint>
#include <span>
#include <vector>

#include "dem/contact/kernels/contact_types.h"
#include "dem/neighbours/cell_grid.h"
#include "dem/neighbours/raw_array.h"
#include "dem/neighbours/reach_plan.h"

namespace venato::dem {

/// Force and torques of one pair on its grains; phase 2 sums them.
struct PairForce {
  Trio on_i, torque_i, torque_j;
};

/// Vector loads may read this many entries beyond the end of a list.
inline constexpr std::size_t kListPadding = 8;

struct PairList {
  std::vector<std::int32_t> first;       ///< [slot + 1] own pairs of each grain
  RawArray<std::int32_t> i, j;           ///< [pair + padding] slots of owner and partner
  RawArray<std::uint8_t> touching;       ///< [pair + padding] 1 or 0
  RawArray<ContactHistory> history;      ///< [pair] defined while touching
  RawArray<PairForce> force;             ///< [pair] defined while touching
  std::vector<std::int32_t> in_first;    ///< [slot + 1] incoming pairs of each grain
  RawArray<std::int32_t> in_place;       ///< [pair] where the pair stands among its partner's incoming ones
  RawArray<std::int32_t> in_pair;        ///< [incoming] the pair
  RawArray<std::uint8_t> in_touching;    ///< [incoming + padding] as touching
  RawArray<std::int64_t> id;             ///< [slot]
  std::size_t grain_count() const { return first.empty() ? 0 : first.size() - 1; }
  std::size_t pair_count() const { return first.empty() ? 0 : static_cast<std::size_t>(first.back()); }
  void resize_pairs(std::size_t n);
};

struct PairListInput {
  std::span<const Sphere> spheres;         ///< new slot order, as all below
  std::span<const Anchor> anchor;
  std::span<const double> reach;
  double life_s;
  std::span<const std::int64_t> id;
  std::span<const std::int32_t> old_slot;  ///< [new slot] slot in the old list; >= old.grain_count() = new grain
  const CellGrid* grid;                    ///< null = brute force
  PeriodicBox box;
  int threads;
};

/// Makes lists; keeps its working memory from one to the next.
class PairListBuilder {
 public:
  /// Rebuilds `list`; histories and forces of touching pairs that are still near are carried over.
  void rebuild(PairList& list, const PairListInput& in);

 private:
  struct Neighbour {
    std::int64_t id;
    std::int32_t slot;
  };
  /// Full rows (partners below and above) of a block of grains, one after the other.
  struct BlockRows {
    std::vector<Neighbour> row;
    std::vector<std::int32_t> end;
    std::span<const Neighbour> of(std::size_t k) const {
      const std::size_t begin = k == 0 ? 0 : static_cast<std::size_t>(end[k - 1]);
      return {row.data() + begin, static_cast<std::size_t>(end[k]) - begin};
    }
  };
  static void find_row(const PairListInput& in, std::int32_t i, std::vector<Neighbour>& out);
  void fill_rows(PairList& list, const PairListInput& in, std::size_t s) const;

  PairList spare_;
  std::vector<BlockRows> rows_;
};
}  // namespace venato::dem
