#pragma once
/// Neighbour lists by blocks of grains, with the contact histories.
///
/// A block (256 grains that are neighbours in space) holds every pair that one of its grains is in. A pair inside the block stands there once; a pair
/// with a grain of another block stands in both, each with its own copy of the history (mirror images: the contact laws are exactly antisymmetric).
/// So a block computes the forces on its grains from nothing but positions and velocities of its surroundings, no force ever goes through memory,
/// and only the pairs across block borders (about a quarter; big and small grains share blocks) are computed twice.
///
/// The pairs of a block stand in the order of their ids (the lower, then the higher). Adding up forces in this order gives every grain its contacts
/// in ascending order of the partner's id, whatever the list: the same bytes however often lists are made, and no searching while adding. Histories
/// are kept for touching pairs only, densely, block by block; a ContactEstate takes them from the old list to the new one.
#include <cstdint>
#include <span>
#include <vector>

#include "dem/contact/kernels/contact_types.h"
#include "dem/neighbours/cell_grid.h"
#include "dem/neighbours/contact_estate.h"
#include "dem/neighbours/raw_array.h"
#include "dem/neighbours/reach_plan.h"

namespace venato::dem {

inline constexpr std::int64_t kGrainsPerBlock = 256;

/// Vector loads may read this many entries beyond the end of a list.
inline constexpr std::size_t kListPadding = 8;

struct Load {
  Trio force, torque;
};

/// Force (0-2) and torque (3-5) on a grain, padded with zeros to the shape of a Motion.
struct alignas(64) LoadRow {
  double v[8] = {};
  Load load() const { return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}; }
};

/// History seen from the other grain.
inline ContactHistory mirrored(const ContactHistory& h) { return {-h.spring, -h.rolling, h.plastic}; }

struct alignas(64) CacheLine {
  double v[8];
};

/// Touching pairs of one block.
struct BlockContacts {
  RawArray<CacheLine> rows;  ///< histories, [place][history width]
  RawArray<LoadRow> kept;    ///< [place] force on the pair's first grain, when it was asked for
  std::uint32_t used = 0;    ///< places taken so far; all below are in use or in `vacant`
  std::vector<std::uint32_t> vacant;
  std::int64_t sides = 0;  ///< touching grains of the block, once for each contact
  double* history(std::uint32_t place, std::uint32_t width) { return rows.data()->v + std::size_t{place} * width; }
  const double* history(std::uint32_t place, std::uint32_t width) const { return rows.data()->v + std::size_t{place} * width; }
  static std::size_t lines(std::size_t places, std::uint32_t width) { return (places * width + 7) / 8; }
  std::uint32_t take(std::uint32_t width) {
    if (vacant.empty()) {
      if (lines(used + 1, width) > rows.size()) rows.grow(lines(used + used / 4 + 16, width));
      return used++;
    }
    const std::uint32_t k = vacant.back();
    vacant.pop_back();
    return k;
  }
};

struct PairList {
  std::vector<std::int32_t> block_first;  ///< [block + 1] pairs of each block
  RawArray<std::uint16_t> own;            ///< [pair + padding] first grain, counted from the block's first
  RawArray<std::int32_t> partner;         ///< [pair + padding] slot of the second grain
  RawArray<std::uint8_t> touching;        ///< [pair + padding] 1 or 0
  RawArray<std::uint32_t> place;          ///< [pair] of the history in the block's part, while touching
  std::uint32_t history_width = 8;        ///< numbers kept of each history: 6 (springs) or 8 (also the plastic overlap)
  std::vector<BlockContacts> contacts;    ///< [block]
  std::size_t grain_count = 0;            ///< slots of the list; later ones are new grains

  std::size_t pair_count() const { return block_first.empty() ? 0 : static_cast<std::size_t>(block_first.back()); }
  static std::size_t block_of(std::size_t slot) { return slot / static_cast<std::size_t>(kGrainsPerBlock); }
  static std::size_t block_start(std::size_t block) { return block * static_cast<std::size_t>(kGrainsPerBlock); }
  ContactHistory history_of(std::size_t block, std::size_t pair) const {
    const double* h = contacts[block].history(place[pair], history_width);
    return {{h[0], h[1], h[2]}, {h[3], h[4], h[5]}, history_width > 6 ? h[6] : 0.0};
  }
  /// Starts (with this history) or ends a contact: marks the pair, takes or frees a place.
  void start(std::size_t block, std::size_t pair, const ContactHistory& h);
  void end(std::size_t block, std::size_t pair);
  void resize(std::size_t pairs);

 private:
  int sides(std::size_t block, std::size_t pair) const { return block_of(static_cast<std::size_t>(partner[pair])) == block ? 2 : 1; }
};

struct PairListInput {
  std::span<const Sphere> spheres;  ///< new slot order, as all below
  std::span<const Anchor> anchor;
  std::span<const double> reach;
  double life_s;
  std::span<const std::int64_t> id;
  std::span<const std::int32_t> old_slot;  ///< [new slot] slot in the old list; beyond it = new grain
  const CellGrid* grid;                    ///< null = brute force
  PeriodicBox box;
  int threads;
};

/// Fills `list`, whose memory is used again; histories of touching pairs that are still near are carried over from `estate`.
void rebuild_pairs(PairList& list, const ContactEstate& estate, const PairListInput& in);
}  // namespace venato::dem
