#pragma once
/// Brings the next block's data into the caches, a little with every piece of work on the present one. A block's data come from a dozen arrays in
/// pieces of a few kilobytes, too short for the processor's own prefetchers; without this the pass waits for memory most of the time (RESULTS.md).
/// Only hints: never changes results.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "dem/simulation/pair_lanes.h"

namespace venato::dem {

class FetchAhead {
 public:
  void restart() { ranges_ = range_ = 0, at_ = 0, pair_ = pairs_ = 0; }
  template <class T>
  void add(const T* first, std::size_t count) {
    if (count == 0 || ranges_ == kMost) return;
    const auto begin = reinterpret_cast<std::uintptr_t>(first) & ~std::uintptr_t{63};
    from_[ranges_] = begin;
    lines_[ranges_++] = (reinterpret_cast<std::uintptr_t>(first + count) - begin + 63) / 64;
  }
  /// Second grains of a block's pairs (its lists are near already).
  void add_partners(const std::int32_t* partner, std::size_t count, const Sphere* sphere, const Motion* motion) {
    partner_ = partner, pairs_ = count, pair_ = 0, sphere_ = sphere, motion_ = motion;
  }
  /// Asks for about `n` cache lines more.
  void some(std::size_t n) {
    while (n > 0 && range_ < ranges_) {
      const std::size_t take = std::min(n, lines_[range_] - at_);
      const auto* p = reinterpret_cast<const char*>(from_[range_]) + 64 * at_;
      for (std::size_t k = 0; k < take; ++k) __builtin_prefetch(p + 64 * k, 0, 3);
      n -= take, at_ += take;
      if (at_ == lines_[range_]) ++range_, at_ = 0;
    }
    for (const std::size_t end = std::min(pairs_, pair_ + n / 2); pair_ < end; ++pair_) {
      __builtin_prefetch(sphere_ + partner_[pair_], 0, 2);
      __builtin_prefetch(motion_ + partner_[pair_], 0, 2);
    }
  }
  void rest() { some(~std::size_t{0} / 2); }

 private:
  static constexpr std::size_t kMost = 16;
  std::uintptr_t from_[kMost] = {};
  std::size_t lines_[kMost] = {}, ranges_ = 0, range_ = 0, at_ = 0, pair_ = 0, pairs_ = 0;
  const std::int32_t* partner_ = nullptr;
  const Sphere* sphere_ = nullptr;
  const Motion* motion_ = nullptr;
};
}  // namespace venato::dem
