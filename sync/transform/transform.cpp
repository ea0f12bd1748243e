#include "sync/transform/transform.h"
#include <Eigen/LU>
#include <cmath>
#include <string>
#include "base/error.h"
namespace venato::sync {
namespace {
constexpr int kMaxIterations = 60;        // Newton needs 3-5; the rest is room for step halving near a fold
constexpr double kTolerance_m = 1e-9;     // the contract of Transform::inverse
constexpr double kMinDeterminant = 1e-6;  // of I + grad u: at or below this the map folds
}  // namespace

Point Transform::operator()(Point green_m) const { return a * (green_m + u.displacement(green_m)) + t; }

Eigen::Matrix2d Transform::jacobian(Point green_m) const { return a * (Eigen::Matrix2d::Identity() + u.gradient(green_m)); }

Point Transform::inverse(Point print_m) const {
  const double determinant = a.determinant();
  if (!(std::abs(determinant) > 1e-12)) throw WorkError("print_from_green cannot be inverted: its linear part is singular");
  const Point target = a.inverse() * (print_m - t);
  Point p = target;
  const auto residual = [&](Point q) -> Point { return q + u.displacement(q) - target; };
  Point r = residual(p);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (r.norm() <= kTolerance_m) return p;
    const Eigen::Matrix2d j = Eigen::Matrix2d::Identity() + u.gradient(p);
    if (!(j.determinant() > kMinDeterminant)) break;
    const Point step = j.inverse() * r;
    double damping = 1;
    Point next = p - step, r_next = residual(next);
    while (!(r_next.norm() < r.norm()) && damping > 1e-3) {
      damping /= 2;
      next = p - damping * step;
      r_next = residual(next);
    }
    p = next;
    r = r_next;
  }
  if (r.norm() <= kTolerance_m) return p;
  throw WorkError("print_from_green folds near green point (" + std::to_string(p.x() * 1e3) + ", " + std::to_string(p.y() * 1e3) +
                  ") mm: it has no inverse there");
}

Lying how_it_lies(const Transform& affine) {
  Lying out;
  Eigen::Matrix2d m = affine.a;
  out.mirrored = m.determinant() < 0;
  if (out.mirrored) m.col(0) *= -1;
  const double angle = std::atan2(m(1, 0) - m(0, 1), m(0, 0) + m(1, 1));
  const int quarters = static_cast<int>(std::lround(angle / (M_PI / 2)));
  out.turn_deg = (quarters + 4) % 4 * 90;
  out.rotation_rad = angle - quarters * (M_PI / 2);
  out.corner_m = affine.t;
  return out;
}
}  // namespace venato::sync
