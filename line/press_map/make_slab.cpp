#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/expects.h"
#include "line/press_map/press_map.h"

namespace venato::line {
namespace {
double bilinear(const std::vector<double>& field, const BedGrid& grid, PlanePoint belt) {
  const double a = std::clamp(belt.x_m / grid.pitch_m - 0.5, 0.0, grid.nx - 1.0), b = std::clamp(belt.y_m / grid.pitch_m - 0.5, 0.0, grid.ny - 1.0);
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b), nx = static_cast<std::size_t>(grid.nx);
  const std::size_t i2 = std::min(i + 1, nx - 1), j2 = std::min(j + 1, static_cast<std::size_t>(grid.ny) - 1);
  const double f = a - static_cast<double>(i), g = b - static_cast<double>(j);
  return (field[j * nx + i] * (1 - f) + field[j * nx + i2] * f) * (1 - g) + (field[j2 * nx + i] * (1 - f) + field[j2 * nx + i2] * f) * g;
}

PlanePoint pressed_from_green(const CutWindow& cut, double x, double y) {
  const double c = std::cos(cut.rotation_rad), s = std::sin(cut.rotation_rad);
  return {cut.x_m + c * x - s * y, cut.y_m + s * x + c * y};
}
}  // namespace

Slab make_slab(Bed bed, const PressMap& map, const CutWindow& cut, double green_pitch_m, int threads) {
  VENATO_EXPECTS(bed.grid == map.grid && green_pitch_m > 0 && threads >= 1);
  const int width = static_cast<int>(std::lround(cut.width_m / green_pitch_m)), height = static_cast<int>(std::lround(cut.length_m / green_pitch_m));
  if (width < 1 || height < 1)
    throw UsageError("press: a cut of " + std::to_string(cut.width_m) + " x " + std::to_string(cut.length_m) + " m is smaller than one pixel of " +
                     std::to_string(green_pitch_m) + " m");
  const double strip_width = map.grid.nx * map.grid.pitch_m, strip_length = map.grid.ny * map.grid.pitch_m;
  for (const double x : {0.0, cut.width_m})
    for (const double y : {0.0, cut.length_m}) {
      const PlanePoint corner = pressed_from_green(cut, x, y), belt = belt_from_pressed(map, corner);
      const double slack = 1e-9;
      if (belt.x_m < -slack || belt.x_m > strip_width + slack || belt.y_m < -slack || belt.y_m > strip_length + slack)
        throw UsageError("press: the cut's corner at x " + std::to_string(corner.x_m) + " m, y " + std::to_string(corner.y_m) +
                         " m lies outside the pressed strip of " + std::to_string(strip_width * (1 + map.config.springback)) + " x " +
                         std::to_string(strip_length * (1 + map.config.springback)) + " m; move or shrink the cut");
    }
  Slab slab;
  slab.in_plane_scale = 1 + map.config.springback;
  slab.sigma_nonaffine_m = map.config.sigma_nonaffine_m;
  slab.thickness_m = slab.density_kg_m3 = slab.pressure_pa = graphics::RasterF(width, height, 1, green_pitch_m);
  slab.belt_from_green_m = graphics::RasterF(width, height, 2, green_pitch_m);
  const double area_scale = slab.in_plane_scale * slab.in_plane_scale;
  std::atomic<bool> folded = false;  // exceptions must not leave a parallel region
#pragma omp parallel for num_threads(threads) schedule(static)
  for (int j = 0; j < height; ++j) try {
      for (int i = 0; i < width; ++i) {
        const PlanePoint belt = belt_from_pressed(map, pressed_from_green(cut, (i + 0.5) * green_pitch_m, (j + 0.5) * green_pitch_m));
        slab.belt_from_green_m.at(i, j, 0) = static_cast<float>(belt.x_m);
        slab.belt_from_green_m.at(i, j, 1) = static_cast<float>(belt.y_m);
        slab.thickness_m.at(i, j) = static_cast<float>(bilinear(map.thickness_m, map.grid, belt));
        slab.density_kg_m3.at(i, j) = static_cast<float>(bilinear(map.density_kg_m3, map.grid, belt) / area_scale);
        slab.pressure_pa.at(i, j) = static_cast<float>(bilinear(map.pressure_pa, map.grid, belt));
      }
    } catch (const WorkError&) {
      folded = true;
    }
  if (folded) throw WorkError("press: the displacement folds inside the cut; the bed's mass varies too steeply for this lateral_length_factor");
  slab.bed = std::move(bed);
  return slab;
}
}  // namespace venato::line
