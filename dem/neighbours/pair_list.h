#pragma once
/// Verlet list with the contact histories. Every pair is owned by the grain with the lower id; rows stand in the spatial order of their owners and
/// are sorted by the partner's id inside, so histories are carried from the old list to the new one by merging sorted rows.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dem/contact/kernels/contact_types.h"
#include "dem/neighbours/cell_grid.h"

namespace venato::dem {

/// Array without initialisation: histories are written when a contact starts, never before.
template <class T>
class RawArray {
 public:
  void resize_for_overwrite(std::size_t n) {
    if (n > capacity_) data_ = std::make_unique_for_overwrite<T[]>(capacity_ = n + n / 8);
    size_ = n;
  }
  std::size_t size() const { return size_; }
  T* data() { return data_.get(); }
  T& operator[](std::size_t k) { return data_[k]; }
  const T& operator[](std::size_t k) const { return data_[k]; }

 private:
  std::unique_ptr<T[]> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

struct Pair {
  std::int32_t j;      ///< slot of the partner (higher id)
  std::int32_t image;  ///< periodic image, index into image_shifts()
};
/// Force and torques of one pair on its grains; phase 2 sums them.
struct PairForce {
  Trio on_i, torque_i, torque_j;
};

inline constexpr std::int32_t kNoImage = 13;
/// Shift added to x_j - x_i for each of the 27 images.
std::vector<Trio> image_shifts(const PeriodicBox& box);

struct PairList {
  std::vector<std::int32_t> first;  ///< [slot + 1] own pairs of each grain
  std::vector<Pair> pair;
  std::vector<std::int64_t> partner;         ///< [pair] id of the partner
  std::vector<std::uint8_t> touching;        ///< [pair]
  RawArray<ContactHistory> history;          ///< [pair] defined while touching
  RawArray<PairForce> force;                 ///< [pair] defined while touching
  std::vector<std::int32_t> incident_first;  ///< [slot + 1]
  std::vector<std::uint32_t> incident;       ///< all pairs of a grain by ascending partner id: 2 * pair + (grain is the partner)
  std::size_t grain_count() const { return first.empty() ? 0 : first.size() - 1; }
};

struct PairListInput {
  std::span<const Sphere> spheres;         ///< new slot order
  std::span<const std::int64_t> id;        ///< new slot order
  std::span<const std::int32_t> old_slot;  ///< [new slot] slot in the old list; >= old.grain_count() = new grain
  const CellGrid* grid;                    ///< null = brute force
  PeriodicBox box;
  double skin;
  int threads;
};
/// Rebuilds `list`; histories and forces of touching pairs that are still near are carried over. `spare` takes the old list and lends its memory.
void rebuild_pairs(PairList& list, PairList& spare, const PairListInput& in);
}  // namespace venato::dem
