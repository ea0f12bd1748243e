#pragma once
#include <Eigen/Core>
namespace venato::graphics {

/// Distortion of a lens after Brown and Conrady, as OpenCV's calibrateCamera gives it. Pixel positions have the centre of the top-left pixel at (0,
/// 0). Source: D. C. Brown, Photogramm. Eng. 32 (1966) 444; names and signs as in OpenCV's calib3d.
struct Lens {
  double fx_px = 1, fy_px = 1, cx_px = 0, cy_px = 0;  ///< focal lengths and principal point
  double k1 = 0, k2 = 0, k3 = 0;                      ///< radial: 1 + k1 r2 + k2 r4 + k3 r6
  double p1 = 0, p2 = 0;                              ///< tangential
};

/// Where a point is in the picture that a camera without distortion would see at `ideal_px`. Only valid within radius_limit().
Eigen::Vector2d distorted(const Lens& lens, const Eigen::Vector2d& ideal_px);
/// Inverse of distorted(), Newton's method to 1e-10 px. \return false where the lens has none (the polynomial folds back)
bool undistorted(const Lens& lens, const Eigen::Vector2d& picture_px, Eigen::Vector2d& ideal_px);
/// Radius (in focal lengths from the principal point) at which the radial polynomial stops growing: farther out it folds back into the picture and
/// means nothing. \param farthest  radii beyond it are of no interest \return `farthest` when it grows all the way
double radius_limit(const Lens& lens, double farthest);
/// Of an undistorted place, in focal lengths.
double radius(const Lens& lens, const Eigen::Vector2d& ideal_px);
}  // namespace venato::graphics
