#include "graphics/rectify/lens.h"

#include <Eigen/LU>
#include <cmath>
namespace venato::graphics {
namespace {
constexpr int kMostSteps = 50;
constexpr double kDone_px = 1e-10;
constexpr int kRadiusSteps = 4000, kFewRadiusSteps = 50;

/// Of normalised coordinates, and its derivative.
Eigen::Vector2d bend(const Lens& l, const Eigen::Vector2d& n, Eigen::Matrix2d* slope) {
  const double x = n.x(), y = n.y(), r2 = x * x + y * y;
  const double radial = 1 + r2 * (l.k1 + r2 * (l.k2 + r2 * l.k3)), d_radial = l.k1 + r2 * (2 * l.k2 + 3 * r2 * l.k3);  // d/d(r2)
  if (slope) {
    const double cross = 2 * x * y * d_radial + 2 * l.p1 * x + 2 * l.p2 * y;
    *slope << radial + 2 * x * x * d_radial + 2 * l.p1 * y + 6 * l.p2 * x, cross, cross, radial + 2 * y * y * d_radial + 6 * l.p1 * y + 2 * l.p2 * x;
  }
  return {x * radial + 2 * l.p1 * x * y + l.p2 * (r2 + 2 * x * x), y * radial + l.p1 * (r2 + 2 * y * y) + 2 * l.p2 * x * y};
}
Eigen::Vector2d normalised(const Lens& l, const Eigen::Vector2d& px) { return {(px.x() - l.cx_px) / l.fx_px, (px.y() - l.cy_px) / l.fy_px}; }
Eigen::Vector2d in_px(const Lens& l, const Eigen::Vector2d& n) { return {l.cx_px + l.fx_px * n.x(), l.cy_px + l.fy_px * n.y()}; }
double limit(const Lens& lens, double farthest, int steps) {
  for (int k = 1; k <= steps; ++k) {
    const double r = farthest * k / steps, r2 = r * r;
    if (!(1 + r2 * (3 * lens.k1 + r2 * (5 * lens.k2 + r2 * 7 * lens.k3)) > 0)) return farthest * (k - 1) / steps;
  }
  return farthest;
}
}  // namespace

Eigen::Vector2d distorted(const Lens& lens, const Eigen::Vector2d& ideal_px) { return in_px(lens, bend(lens, normalised(lens, ideal_px), nullptr)); }

bool undistorted(const Lens& lens, const Eigen::Vector2d& picture_px, Eigen::Vector2d& ideal_px) {
  const Eigen::Vector2d wanted = normalised(lens, picture_px);
  Eigen::Vector2d n = wanted;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Matrix2d slope;
    const Eigen::Vector2d miss = bend(lens, n, &slope) - wanted;
    if (!miss.allFinite() || !(slope.determinant() > 0)) return false;
    if (std::hypot(miss.x() * lens.fx_px, miss.y() * lens.fy_px) < kDone_px) {
      ideal_px = in_px(lens, n);
      return n.norm() <= limit(lens, n.norm(), kFewRadiusSteps);
    }
    n -= slope.inverse() * miss;
  }
  return false;
}

double radius(const Lens& lens, const Eigen::Vector2d& ideal_px) { return normalised(lens, ideal_px).norm(); }

double radius_limit(const Lens& lens, double farthest) { return limit(lens, farthest, kRadiusSteps); }
}  // namespace venato::graphics
