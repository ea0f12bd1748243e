#include "sync/mask/powder_rows.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace venato::sync {
namespace {

struct LinearTap {
  int first, second;
  float weight;  ///< of the second
};

/// Taps of raster pixels at `count` output pixels of `pitch_m`, from number `begin`.
std::vector<LinearTap> taps_along(std::int64_t begin, std::int64_t count, double pitch_m, int side, double side_pitch_m) {
  std::vector<LinearTap> taps;
  taps.reserve(static_cast<std::size_t>(count));
  for (std::int64_t k = begin; k < begin + count; ++k) {
    const double s = std::clamp((static_cast<double>(k) + 0.5) * pitch_m / side_pitch_m - 0.5, 0.0, side - 1.0);
    const int first = static_cast<int>(s);
    const auto weight = static_cast<float>(s - first);
    // On a pixel centre the neighbour must not count at all: it may be NaN (no data), and 0 * NaN is NaN.
    taps.push_back({first, weight > 0 ? std::min(first + 1, side - 1) : first, weight});
  }
  return taps;
}

const graphics::RasterF& raster_of(const PowderMask& powder) { return powder.fraction.empty() ? powder.signed_distance_m : powder.fraction; }

}  // namespace

WarpGrid own_grid(const PowderMask& powder) {
  const graphics::RasterF& raster = raster_of(powder);
  return {raster.width, raster.height, raster.pitch_m};
}

void powder_rows(const PowderMask& powder, const WarpGrid& grid, std::int64_t first_row, int rows, std::span<std::uint8_t> out, int threads) {
  const graphics::RasterF& raster = raster_of(powder);
  VENATO_EXPECTS(!raster.empty() && raster.channels == 1 && raster.pitch_m > 0);
  VENATO_EXPECTS(out.size() == static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(rows));
  const bool distance = powder.fraction.empty();
  const auto gain = static_cast<float>(distance ? 1 / powder.feather_m : 1.0);
  const auto offset = static_cast<float>(distance ? 0.5 + powder.spread_m / powder.feather_m : 0.0);
  const auto columns = taps_along(0, grid.width, grid.pitch_m, raster.width, raster.pitch_m);
  const auto lines = taps_along(first_row, rows, grid.pitch_m, raster.height, raster.pitch_m);
#pragma omp parallel for num_threads(threads) if (threads > 1)
  for (int r = 0; r < rows; ++r) {
    const LinearTap& line = lines[static_cast<std::size_t>(r)];
    const float* upper = raster.data.data() + raster.index(0, line.first);
    const float* lower = raster.data.data() + raster.index(0, line.second);
    std::uint8_t* to = out.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(grid.width);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const LinearTap& column = columns[k];
      const float u = upper[column.first] + column.weight * (upper[column.second] - upper[column.first]);
      const float l = lower[column.first] + column.weight * (lower[column.second] - lower[column.first]);
      const float coverage = (u + line.weight * (l - u)) * gain + offset;
      to[k] = static_cast<std::uint8_t>((coverage > 0 ? std::min(coverage, 1.0f) : 0.0f) * 255.0f + 0.5f);  // NaN counts as no powder
    }
  }
}

}  // namespace venato::sync
