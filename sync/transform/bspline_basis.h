#pragma once
#include <algorithm>
#include <array>
#include <cmath>
namespace venato::sync {

/// Where a coordinate falls on a uniform cubic B-spline axis: first of the four coefficients and their weights.
/// Source: Unser, "Splines: a perfect fit", IEEE Signal Processing Magazine 16 (1999), eq. 3 for degree 3.
struct SplineCell {
  int first = 0;
  std::array<double, 4> weight{};      ///< sums to 1
  std::array<double, 4> derivative{};  ///< d weight / d position [1/spacing]; 0 where the position was clamped
};

/// \param s  position in spacings from the start of the axis; clamped to [0, n - 3]
/// \param n  number of coefficients, >= 4
inline SplineCell spline_cell(double s, int n) {
  const double last = n - 3;
  const bool clamped = !(s >= 0 && s <= last);
  s = s >= 0 ? std::min(s, last) : 0;
  SplineCell cell;
  cell.first = std::min(static_cast<int>(s), n - 4);
  const double f = s - cell.first, g = 1 - f;
  cell.weight = {g * g * g / 6, (3 * f * f * f - 6 * f * f + 4) / 6, (3 * g * g * g - 6 * g * g + 4) / 6, f * f * f / 6};
  if (!clamped) cell.derivative = {-g * g / 2, (3 * f * f - 4 * f) / 2, -(3 * g * g - 4 * g) / 2, f * f / 2};
  return cell;
}
}  // namespace venato::sync
