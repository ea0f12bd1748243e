#pragma once
/// The vector code around the contact laws: which listed pairs touch, and their state in and out of lanes. Highway: one binary, the CPU's best
/// instructions chosen at run time; every lane does the same operations on every CPU, so the bytes do not depend on it.
#include <cstddef>
#include <cstdint>

#include "dem/contact/kernels/pair_batch.h"
#include "dem/neighbours/cell_grid.h"
#include "dem/neighbours/pair_list.h"

namespace venato::dem {

/// What a touching pair reads besides the spheres: one cache line.
struct alignas(64) Motion {
  Trio velocity, spin;
  double inverse_mass;     ///< 0 = frozen
  double inverse_inertia;  ///< 2.5 / (m R^2); 0 = frozen
};

/// One block's lists, and the grains, as the vector code sees them. Pairs count from the block's first.
struct PairView {
  const Sphere* sphere;
  const Motion* motion;
  std::size_t block_start;  ///< slot
  const std::uint16_t* own;
  const std::int32_t* partner;
  const std::uint8_t* touching;
  const std::uint32_t* place;
  double* history;                      ///< [place][history_width]
  std::uint32_t history_width;          ///< 6 or 8
  LoadRow* sum;                         ///< [grain of the block, and one more for grains of other blocks] forces are added to it
  LoadRow* kept;                        ///< [place] out: on the first grain; null: not wanted
  double length[3], inverse_length[3];  ///< of the periodic box; 0 = not periodic
  bool periodic;
  std::size_t first(std::size_t pair) const { return block_start + own[pair]; }
  std::size_t second(std::size_t pair) const { return static_cast<std::size_t>(partner[pair]); }
};

/// Largest number of pairs that find_touching() takes at once.
inline constexpr std::size_t kScanChunk = 1024;

/// Room for a chunk of pairs; the vector code may write 8 entries more.
struct PairChunk {
  std::uint32_t pair[kScanChunk + 8];
  std::size_t count = 0;
};

/// Tests pairs from … to - 1 (at most kScanChunk).
/// \param now     those that touch, ascending
/// \param changed those whose mark in v.touching says something else
void find_touching(const PairView& v, std::size_t from, std::size_t to, PairChunk& now, PairChunk& changed);

/// Fills the first `count` lanes (1 … kBatchWidth) of the batch with the touching pairs, and those up to the next multiple of 8 with the last of
/// them. Materials (b.parameter) and pairs of two frozen grains are the caller's.
void load_lanes(const PairView& v, const std::uint32_t* pair, int count, PairBatch& b);
/// A block's grains, for moving them on.
struct MoveView {
  const Sphere* sphere;
  const Motion* motion;
  Sphere* next_sphere;
  Motion* next_motion;
  const LoadRow* sum;    ///< [grain of the block] forces; null: take `load` instead
  const Load* load;      ///< [slot]
  double time_step;
  LoadRow gravity;   ///< (g, 0)
  double snap[4];    ///< the last is 0
  double centre[4];  ///< velocity that MoveBook::relative counts from; the last is 0
  bool stream;       ///< next_* past the caches: nobody reads them before the caches have forgotten them
};
struct MoveBook {
  double speed2 = 0;
  std::size_t fastest = ~std::size_t{0};  ///< slot; all ones = nobody moves
  alignas(32) double relative[4] = {};    ///< largest |velocity - centre| of each axis; a NaN may be missing, speed2 has it
};

/// Second half kick of the last step (if forces are given), first half kick of this one, drift: start … end - 1 from sphere, motion to next_*.
void move_grains(const MoveView& v, std::size_t start, std::size_t end, MoveBook& book);
/// What was written past the caches stands in memory for the other threads to see.
void flush_stream();

/// Puts histories back and adds the forces to the sums, contact by contact in their order. \return lanes (one bit each) whose overlap is above
/// `watch` radii of the smaller grain
std::uint32_t add_lanes(const PairView& v, const std::uint32_t* pair, int count, const PairBatch& b, double watch);
}  // namespace venato::dem
