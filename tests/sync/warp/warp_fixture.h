#pragma once
#include <cmath>
#include <cstdint>
#include <vector>
#include "base/rng.h"
#include "graphics/raster/raster.h"
#include "sync/transform/transform.h"
#include "sync/warp/warp.h"
namespace venato::sync::test {

/// White noise: the hardest picture for an interpolation (neighbours differ by up to 255 levels).
inline graphics::Raster8 noise(int width, int height, int channels, double pitch_m, std::uint64_t seed = 1) {
  graphics::Raster8 image(width, height, channels, pitch_m);
  Rng rng(seed, stream_id("test/warp/noise"));
  for (auto& v : image.data) v = static_cast<std::uint8_t>(rng.below(256));
  return image;
}

/// Pose with 1.2 deg, 0.5 % scale and a spline of `amplitude_m` over the rectangle width x height.
inline Transform bent(double width_m, double height_m, double spacing_m, double amplitude_m, std::uint64_t seed = 7) {
  Transform map;
  const double angle = 0.021, scale = 1.005;
  map.a << scale * std::cos(angle), -scale * std::sin(angle), scale * std::sin(angle), scale * std::cos(angle);
  map.t = Point(0.0123, -0.0045);
  map.u.origin_m = Point(-0.3 * spacing_m, -0.6 * spacing_m);
  map.u.spacing_m = spacing_m;
  map.u.nx = 4 + static_cast<int>(std::ceil(width_m / spacing_m));
  map.u.ny = 4 + static_cast<int>(std::ceil(height_m / spacing_m));
  Rng rng(seed, stream_id("test/warp/spline"));
  for (int k = 0; k < map.u.nx * map.u.ny; ++k) {
    map.u.cx.push_back(amplitude_m * (2 * rng.uniform() - 1));
    map.u.cy.push_back(amplitude_m * (2 * rng.uniform() - 1));
  }
  return map;
}

/// The obvious warp in double precision: value of channel c at source position (x, y) [px], -1 = outside.
inline double sample_slowly(const graphics::Raster8& source, double x, double y, int c) {
  if (x < -1.5 || y < -1.5 || x > source.width + 0.5 || y > source.height + 0.5) return -1;
  x = std::min(std::max(x, 0.0), source.width - 1.0);
  y = std::min(std::max(y, 0.0), source.height - 1.0);
  const int i = static_cast<int>(x), j = static_cast<int>(y), i1 = std::min(i + 1, source.width - 1), j1 = std::min(j + 1, source.height - 1);
  const double fx = x - i, fy = y - j;
  return (1 - fy) * ((1 - fx) * source.at(i, j, c) + fx * source.at(i1, j, c)) + fy * ((1 - fx) * source.at(i, j1, c) + fx * source.at(i1, j1, c));
}

inline std::vector<std::uint8_t> warp_all(const graphics::Raster8& source, const Transform& map, const WarpGrid& grid, int strip, int threads) {
  const auto row_bytes = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(source.channels);
  std::vector<std::uint8_t> out(row_bytes * static_cast<std::size_t>(grid.height));
  for (std::int64_t row = 0; row < grid.height; row += strip) {
    const int rows = static_cast<int>(std::min<std::int64_t>(strip, grid.height - row));
    warp_rows(source, map, grid, row, rows,
              std::span(out).subspan(static_cast<std::size_t>(row) * row_bytes, row_bytes * static_cast<std::size_t>(rows)), threads);
  }
  return out;
}
}  // namespace venato::sync::test
