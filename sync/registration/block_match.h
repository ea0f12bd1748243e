#pragma once
#include <Eigen/Core>
#include <vector>
#include "sync/registration/image_ops.h"
namespace venato::sync {

/// One matched block: how far the print must still be moved there, and how well each direction is known.
struct BlockMatch {
  Point at_m;                                             ///< green frame: gradient-energy centroid of the block, where the measurement belongs
  Point shift_m;                                          ///< found shift: slab(p) looks like the warped print at p + shift
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  ///< [1/mm^2], only relative size means something
  double ncc = 0;
  int column = 0, row = 0;  ///< block grid position
  bool faded = false;       ///< texture below 0.25 of the picture's
};
struct BlockSettings {
  double half_m = 0, step_m = 0, search_m = 0;
};
struct BlockResult {
  std::vector<BlockMatch> matches;
  int textured = 0;  ///< blocks whose slab side shows veins inside the overlap (the ones that ought to match)
};
/// NCC block matching: integer peak, one Newton step on the NCC for the sub-pixel part, information matrix W = -Hessian v / (1 - v) from a
/// least-squares quadratic on 5 x 5 (its top is not used for the position: biased by 0.1-0.2 mm).
/// \param green, warped_print  same grid
/// \param texture  the slab picture smoothed against noise, any pitch: says where veins are (`textured`: standard deviation >= 0.25 of the picture's)
/// Rejected: texture below 0.08 of the picture's standard deviation, peak below 0.2 (below 0.5 where the texture is under 0.25), peak on the rim of
/// the search, less than 70 % valid. Source: registration_print.md 1.3 step 3.
BlockResult match_blocks(const Feature& green, const Feature& texture, const Feature& warped_print, const BlockSettings& settings, int threads);
}  // namespace venato::sync
