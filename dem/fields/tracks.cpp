#include "dem/fields/tracks.h"

#include <numbers>

#include "base/expects.h"

namespace venato::dem {
namespace {
double volume_of(float radius) {
  const auto r = static_cast<double>(radius);
  return 4.0 / 3 * std::numbers::pi * r * r * r;
}

/// Path number of every grain of every frame, by merging each frame's sorted ids with those of the frame before.
std::vector<std::vector<std::size_t>> path_numbers(std::span<const Snapshot> frames, Tracks& tracks, std::vector<std::size_t>& length) {
  std::vector<std::vector<std::size_t>> path(frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Snapshot& now = frames[f];
    VENATO_EXPECTS(now.position_m.size() == now.id.size() && now.radius_m.size() == now.id.size());
    path[f].resize(now.id.size());
    std::size_t before = 0;
    for (std::size_t k = 0; k < now.id.size(); ++k) {
      VENATO_EXPECTS(k == 0 || now.id[k] > now.id[k - 1]);
      while (f > 0 && before < frames[f - 1].id.size() && frames[f - 1].id[before] < now.id[k]) ++before;
      if (f > 0 && before < frames[f - 1].id.size() && frames[f - 1].id[before] == now.id[k]) {
        path[f][k] = path[f - 1][before];
        ++length[path[f][k]];
      } else {
        path[f][k] = length.size();
        length.push_back(1);
        tracks.first_frame.push_back(static_cast<std::int32_t>(f));
        tracks.volume_m3.push_back(volume_of(now.radius_m[k]));
      }
    }
  }
  return path;
}
}  // namespace

Tracks make_tracks(std::span<const Snapshot> frames) {
  Tracks tracks;
  std::vector<std::size_t> length;
  const auto path = path_numbers(frames, tracks, length);
  tracks.start.assign(length.size() + 1, 0);
  for (std::size_t p = 0; p < length.size(); ++p) tracks.start[p + 1] = tracks.start[p] + length[p];
  tracks.position_m.resize(tracks.start.back());
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t k = 0; k < frames[f].id.size(); ++k) {
      const std::size_t p = path[f][k];
      tracks.position_m[tracks.start[p] + f - static_cast<std::size_t>(tracks.first_frame[p])] = frames[f].position_m[k];
    }
  return tracks;
}
}  // namespace venato::dem
