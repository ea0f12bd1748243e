#pragma once
#include <array>
#include "sync/registration/ncc_surface.h"
namespace venato::sync {

/// Sums over a rectangle of a picture whose value is 0 where it is invalid.
struct RectSums {
  double sum = 0, squares = 0;
};
/// Of n pixels in a row.
RectSums row_sums(const float* row, int n);
/// \pre the rectangle lies inside f
RectSums rect_sums(const Feature& f, int x0, int y0, int x1, int y1);
/// Gradient energy decides which part of the block a shift speaks for: a vein that crosses a corner measures the corner. [px]
Point energy_centroid(const Patch& block);

/// Sums for one Newton step on the NCC of a block t and a window w at an integer shift: over the pixels where both and w's neighbours are valid.
struct StepSums {
  double n = 0, t = 0, w = 0, tt = 0, ww = 0, tw = 0;
  Point g = Point::Zero(), tg = Point::Zero(), wg = Point::Zero();  ///< g = central difference of w
  Eigen::Matrix2d gg = Eigen::Matrix2d::Zero();
};
/// \param x0, y0  where the block lies in the window; one pixel around must exist
StepSums step_sums(const Patch& block, const Patch& window, int x0, int y0);
}  // namespace venato::sync
