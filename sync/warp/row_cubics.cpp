#include "sync/warp/row_cubics.h"

#include <algorithm>
#include <cmath>

namespace venato::sync {
namespace {

/// Coefficients of the cubic through v at t = 0, 1/3, 2/3, 1.
std::array<double, 4> cubic_through(double v0, double v1, double v2, double v3) {
  return {v0, -5.5 * v0 + 9.0 * v1 - 4.5 * v2 + v3, 9.0 * v0 - 22.5 * v1 + 18.0 * v2 - 4.5 * v3, -4.5 * v0 + 13.5 * v1 - 13.5 * v2 + 4.5 * v3};
}

}  // namespace

std::vector<RowCubic> row_cubics(const Transform& source_from_green, double source_pitch_m, const WarpGrid& grid, std::int64_t row) {
  const double y_m = (static_cast<double>(row) + 0.5) * grid.pitch_m;
  const double width_m = static_cast<double>(grid.width) * grid.pitch_m;
  const bool spline = source_from_green.u.spacing_m > 0 && source_from_green.u.nx > 0;
  const double step_m = spline ? source_from_green.u.spacing_m : width_m;
  const double origin_m = spline ? source_from_green.u.origin_m.x() : 0.0;
  const auto first_column_at = [&](double x_m) {  // the first pixel whose centre is not left of x
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(x_m / grid.pitch_m - 0.5)), 0, grid.width);
  };

  std::vector<RowCubic> runs;
  std::int64_t done = 0;
  Point left = Point::Zero();
  bool have_left = false;
  for (auto k = static_cast<std::int64_t>(std::floor(-origin_m / step_m)); done < grid.width; ++k) {
    const double x0_m = origin_m + static_cast<double>(k) * step_m;
    // Without spline the only knot interval is the row itself; rounding must not open a second one.
    const std::int64_t end = spline ? first_column_at(x0_m + step_m) : grid.width;
    if (end <= done) {
      have_left = false;
      continue;
    }
    const auto at = [&](double t) {
      const Point p = source_from_green(Point(x0_m + t * step_m, y_m));
      return Point(p.x() / source_pitch_m - 0.5, p.y() / source_pitch_m - 0.5);
    };
    const Point p0 = have_left ? left : at(0), p1 = at(1.0 / 3.0), p2 = at(2.0 / 3.0), p3 = at(1);
    RowCubic run;
    run.first = done;
    run.count = end - done;
    run.t0 = ((static_cast<double>(done) + 0.5) * grid.pitch_m - x0_m) / step_m;
    run.dt = grid.pitch_m / step_m;
    run.x = cubic_through(p0.x(), p1.x(), p2.x(), p3.x());
    run.y = cubic_through(p0.y(), p1.y(), p2.y(), p3.y());
    runs.push_back(run);
    left = p3;
    have_left = true;
    done = end;
  }
  return runs;
}

RowPositions source_positions(const Transform& source_from_green, double source_pitch_m, const WarpGrid& grid, std::int64_t row) {
  RowPositions out;
  for (const RowCubic& run : row_cubics(source_from_green, source_pitch_m, grid, row)) {
    for (std::int64_t k = 0; k < run.count; ++k) {
      const double t = run.t0 + static_cast<double>(k) * run.dt;
      out.x.push_back(((run.x[3] * t + run.x[2]) * t + run.x[1]) * t + run.x[0]);
      out.y.push_back(((run.y[3] * t + run.y[2]) * t + run.y[1]) * t + run.y[0]);
    }
  }
  return out;
}

}  // namespace venato::sync
