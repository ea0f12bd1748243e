#pragma once
#include <cstdint>
#include <span>
#include <vector>
#include "dem/snapshot.h"
namespace venato::dem {

/// Uninterrupted paths of grains through the frames of a window: path p covers entries [start[p], start[p+1]) of the flat arrays, one entry per
/// consecutive frame beginning with first_frame[p]. A grain that leaves and comes back has two paths.
struct Tracks {
  std::vector<std::size_t> start;         ///< size paths + 1
  std::vector<std::int32_t> first_frame;  ///< per path
  std::vector<double> volume_m3;          ///< per path
  std::vector<Vec3> position_m;           ///< per entry
  std::size_t count() const { return first_frame.size(); }
};
/// Frames as in estimate_fields (ids sorted).
Tracks make_tracks(std::span<const Snapshot> frames);
}  // namespace venato::dem
