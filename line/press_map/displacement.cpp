#include "line/press_map/displacement.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace venato::line {
namespace {
constexpr double kInverseTolerance_m = 1e-10;  // last step; with a contraction below 0.9 the error left is under 1e-9 m
constexpr int kInverseRounds = 400;
}  // namespace

double edge_shift(const PressMap& map, double x_m) {
  const double gain = map.config.edge_gain_m, zone = map.config.edge_zone_m;
  if (gain == 0) return 0;
  const double width = map.grid.nx * map.grid.pitch_m;
  const auto fading = [&](double from_wall) {
    const double t = std::clamp(1 - from_wall / zone, 0.0, 1.0);
    return gain * t * t;
  };
  return fading(width - x_m) - fading(x_m);
}

PlanePoint displacement_at(const PressMap& map, PlanePoint belt) {
  const int nx = map.grid.nx, ny = map.grid.ny;
  const double a = std::clamp(belt.x_m / map.grid.pitch_m - 0.5, -0.5, nx - 0.5), b = belt.y_m / map.grid.pitch_m - 0.5;
  const int i = static_cast<int>(std::floor(a)), j = static_cast<int>(std::floor(b));
  const double f = a - i, g = b - j;
  PlanePoint u{0, 0};
  for (int dj = 0; dj <= 1; ++dj)
    for (int di = 0; di <= 1; ++di) {
      int column = i + di;
      const bool mirrored = column < 0 || column >= nx;
      column = std::clamp(column, 0, nx - 1);
      const auto at = static_cast<std::size_t>(((j + dj) % ny + ny) % ny) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(column);
      const double w = (di ? f : 1 - f) * (dj ? g : 1 - g);
      u.x_m += w * (mirrored ? -map.lateral_x_m[at] : map.lateral_x_m[at]);
      u.y_m += w * map.lateral_y_m[at];
    }
  u.x_m += edge_shift(map, belt.x_m);
  return u;
}

PlanePoint pressed_from_belt(const PressMap& map, PlanePoint belt) {
  const PlanePoint u = displacement_at(map, belt);
  const double scale = 1 + map.config.springback;
  return {scale * (belt.x_m + u.x_m), scale * (belt.y_m + u.y_m)};
}

PlanePoint belt_from_pressed(const PressMap& map, PlanePoint pressed) {
  const double scale = 1 + map.config.springback;
  const PlanePoint target{pressed.x_m / scale, pressed.y_m / scale};
  PlanePoint belt = target;
  for (int round = 0; round < kInverseRounds; ++round) {
    const PlanePoint u = displacement_at(map, belt);
    const PlanePoint next{target.x_m - u.x_m, target.y_m - u.y_m};
    const double step = std::hypot(next.x_m - belt.x_m, next.y_m - belt.y_m);
    belt = next;
    if (step <= kInverseTolerance_m) return belt;
  }
  throw WorkError("press: the displacement folds near x " + std::to_string(belt.x_m) + " m, y " + std::to_string(belt.y_m) +
                  " m; the bed's mass varies too steeply there for this lateral_length_factor");
}
}  // namespace venato::line
