#pragma once
#include <array>
#include <cstdint>
#include <vector>
#include "sync/warp/warp.h"
namespace venato::sync {

/// Source position of a run of output pixels of one row: with t = t0 + k dt for the k-th pixel of the run,
/// position = ((c[3] t + c[2]) t + c[1]) t + c[0]   [source px].
struct RowCubic {
  std::int64_t first = 0, count = 0;  ///< output columns
  double t0 = 0, dt = 0;
  std::array<double, 4> x{}, y{};
};

/// The runs of one output row, left to right, covering every column once: one run per knot interval of the spline (one in all without spline).
/// Between knots the transform is a cubic of x, so the cubic through four of its values is the transform itself.
std::vector<RowCubic> row_cubics(const Transform& source_from_green, double source_pitch_m, const WarpGrid& grid, std::int64_t row);
}  // namespace venato::sync
