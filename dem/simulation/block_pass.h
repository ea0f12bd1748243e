#pragma once
/// One pass over a block of grains: which pairs touch, their forces, walls, sums. Everything that it writes belongs to the block, and what it reads of
/// other blocks (positions, velocities) stands still meanwhile.
#include <bit>
#include <cstring>
#include <vector>

#include "dem/simulation/fetch_ahead.h"
#include "dem/simulation/impl.h"

namespace venato::dem {

/// Working memory of one thread.
struct BlockScratch {
  PairBatch batch;
  PairChunk touching, changed;
  std::vector<PairForce> force;
  std::vector<WallContact> wall;
  FetchAhead ahead;
};

/// Wall clock of the parts of a pass, sampled on some of the blocks: what --profile shows.
struct PassClock {
  double scan = 0, contact = 0, walls = 0, integrate = 0;
};

/// Law parameters that are the same for all pairs go into the batch once.
void prepare_batch(const Simulation::Impl& sim, PairBatch& batch);

/// Forces on the grains of block b by pairs and walls, histories advanced by dt (0: forces only). Fills book and wall contacts.
/// \param force [place] out: forces of the block's pairs
template <class L>
void block_forces(Simulation::Impl& sim, const LawTable<L>& table, double dt, std::size_t b, BlockScratch& scratch, PairForce* force, PassClock* clock);

/// f(k) for every k in [first, last) whose byte is 1, without looking at the others.
template <class F>
void for_marked(const std::uint8_t* mark, std::int32_t first, std::int32_t last, const F& f) {
  for (std::int32_t k = first; k < last; k += 8) {
    std::uint64_t word;
    std::memcpy(&word, mark + k, 8);  // the lists are padded
    if (last - k < 8) word &= (std::uint64_t{1} << (8 * (last - k))) - 1;
    for (; word != 0; word &= word - 1) f(static_cast<std::size_t>(k) + static_cast<std::size_t>(std::countr_zero(word)) / 8);
  }
}

/// Sum of a grain's contacts: pairs in ascending order of the partners' ids, then walls.
/// \param force [place] of the grain's block
inline Load contact_load(const Simulation::Impl& sim, std::size_t s, const PairForce* force) {
  const PairList& list = sim.pairs;
  const std::uint32_t* place = list.place.data() + list.block_first[PairList::block_of(s)];
  Load sum;
  for_marked(list.row_touching.data(), list.row_first[s], list.row_first[s + 1], [&](std::size_t e) {
    const RowEntry entry = list.row[e];
    const PairForce& f = force[place[entry.pair()]];
    if (entry.second())
      sum.force = sum.force - f.on_i, sum.torque = sum.torque + f.torque_j;
    else
      sum.force = sum.force + f.on_i, sum.torque = sum.torque + f.torque_i;
  });
  for (std::size_t k = 0; k < sim.wall_list.contact_count[s]; ++k) {
    const WallContact& w = sim.wall_list.contact[static_cast<std::size_t>(sim.wall_list.contact_first[s]) + k];
    sum.force = sum.force + w.on_grain, sum.torque = sum.torque + w.torque_on_grain;
  }
  return sum;
}
}  // namespace venato::dem
