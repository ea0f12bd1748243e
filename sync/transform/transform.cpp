#include "sync/transform/transform.h"
#include <Eigen/Eigenvalues>
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

SlabStretch slab_stretch(const Transform& affine) {
  const Eigen::Matrix2d square = affine.a.transpose() * affine.a;
  if (!(square.determinant() > 1e-24)) throw WorkError("the stretch of a singular map is not defined");
  const Eigen::Matrix2d slab_from_graphic = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(square).operatorInverseSqrt();
  return {slab_from_graphic(1, 1) - 1, slab_from_graphic(0, 0) - 1, 2 * slab_from_graphic(0, 1)};
}

Transform mean_affine(const Transform& map, double width_m, double height_m, double step_m) {
  const int columns = static_cast<int>(width_m / step_m), rows = static_cast<int>(height_m / step_m);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Point p((i + 0.5) * width_m / columns, (j + 0.5) * height_m / rows);
      const Eigen::Vector3d row(p.x(), p.y(), 1);
      normal += row * row.transpose();
      right += row * map(p).transpose();
    }
  const Eigen::Matrix<double, 3, 2> fit = normal.inverse() * right;
  Transform out;
  out.a = fit.topRows<2>().transpose();
  out.t = fit.row(2).transpose();
  return out;
}
}  // namespace venato::sync
