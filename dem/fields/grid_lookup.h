#pragma once
#include <array>
#include <cmath>
#include <optional>
#include "dem/fields/window_fields.h"
namespace venato::dem {

/// Where a point lies on a FieldGrid; y wraps when periodic.
class GridLookup {
 public:
  GridLookup(const FieldGrid& grid, bool periodic_y) : grid_(grid), periodic_(periodic_y) {}

  /// Cell that holds the point; none outside the grid.
  std::optional<std::size_t> cell(double y_m, double z_m) const {
    const double gy = std::floor(wrapped(y_m)), gz = std::floor((z_m - grid_.z0_m) / grid_.cell_m);
    if (!(gy >= 0 && gy < grid_.ny && gz >= 0 && gz < grid_.nz)) return std::nullopt;
    return grid_.index(static_cast<int>(gy), static_cast<int>(gz));
  }

  /// Four cells around the point with bilinear weights (cell centres at half). Beyond the outer centres the outer cell takes all (periodic: wraps),
  /// so that the weights always sum to 1: cloud-in-cell that loses nothing.
  struct Corners {
    std::array<std::size_t, 4> cell;
    std::array<double, 4> weight;
  };
  Corners corners(double y_m, double z_m) const {
    const auto [i0, i1, fy] = split(wrapped(y_m) - 0.5, grid_.ny, periodic_);
    const auto [j0, j1, fz] = split((z_m - grid_.z0_m) / grid_.cell_m - 0.5, grid_.nz, false);
    return {{grid_.index(i0, j0), grid_.index(i1, j0), grid_.index(i0, j1), grid_.index(i1, j1)},
            {(1 - fy) * (1 - fz), fy * (1 - fz), (1 - fy) * fz, fy * fz}};
  }

 private:
  struct Split {
    int low, high;
    double fraction;
  };
  static Split split(double g, int n, bool wraps) {
    const double floor = std::floor(g);
    const int k = static_cast<int>(floor);
    if (wraps) return {(k % n + n) % n, ((k + 1) % n + n) % n, g - floor};
    if (k < 0) return {0, 0, 0};
    if (k >= n - 1) return {n - 1, n - 1, 0};
    return {k, k + 1, g - floor};
  }
  double wrapped(double y_m) const {  // in cells
    const double g = (y_m - grid_.y0_m) / grid_.cell_m;
    if (!periodic_) return g;
    const double w = g - grid_.ny * std::floor(g / grid_.ny);
    return w < grid_.ny ? w : 0;
  }
  const FieldGrid& grid_;
  bool periodic_;
};
}  // namespace venato::dem
