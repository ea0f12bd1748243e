#pragma once
/// One pass over a block of grains: which pairs touch, their forces, walls, sums. Everything that it writes belongs to the block, and what it reads
/// of other blocks (positions, velocities) stands still meanwhile.
#include <vector>

#include "dem/simulation/fetch_ahead.h"
#include "dem/simulation/impl.h"

namespace venato::dem {

/// Working memory of one thread.
struct BlockScratch {
  PairBatch batch;
  PairChunk touching, changed;
  LoadRow sum[kGrainsPerBlock + 1];  ///< forces on the block's grains; the last takes what belongs to other blocks
  WallScratch wall;
  FetchAhead ahead;
};

/// Wall clock of the parts of a pass, sampled on some of the blocks: what --profile shows.
struct PassClock {
  double scan = 0, contact = 0, walls = 0, integrate = 0;
};

/// Law parameters that are the same for all pairs go into the batch once.
void prepare_batch(const Simulation::Impl& sim, PairBatch& batch);

/// Forces on the grains of block b by pairs and walls, histories advanced by dt (0: forces only). Fills book and wall contacts.
/// scratch.sum holds the forces afterwards: pairs in ascending order of the partners' ids, then walls.
/// \param keep also leave the forces on the pairs' first grains in the block's contacts
template <class L>
void block_forces(Simulation::Impl& sim, const LawTable<L>& table, double dt, std::size_t b, BlockScratch& scratch, bool keep, PassClock* clock);
}  // namespace venato::dem
