#include "graphics/rectify/homography.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

#include "base/expects.h"
namespace venato::graphics {
namespace {
constexpr double kWellPosed = 1e-4;  // smallest over largest singular value, of normalised points; 0.3 for a square's corners
constexpr int kMostSteps = 20;
constexpr double kDone = 1e-14;

/// Centroid to the origin, mean distance sqrt 2.
std::optional<Eigen::Matrix3d> normalising(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const auto& p : points) centre += p / static_cast<double>(points.size());
  double mean = 0;
  for (const auto& p : points) mean += (p - centre).norm() / static_cast<double>(points.size());
  if (!(mean > 0) || !std::isfinite(mean)) return std::nullopt;
  const double s = std::sqrt(2.0) / mean;
  Eigen::Matrix3d t;
  t << s, 0, -s * centre.x(), 0, s, -s * centre.y(), 0, 0, 1;
  return t;
}
Eigen::Matrix3d matrix(const Eigen::VectorXd& h) {
  Eigen::Matrix3d m;
  m << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return m;
}
}  // namespace

Eigen::Vector2d project(const Eigen::Matrix3d& h, const Eigen::Vector2d& p) { return (h * p.homogeneous()).hnormalized(); }

Eigen::Matrix2d project_slope(const Eigen::Matrix3d& h, const Eigen::Vector2d& p) {
  const Eigen::Vector3d v = h * p.homogeneous();
  return (h.topLeftCorner<2, 2>() - v.hnormalized() * h.block<1, 2>(2, 0)) / v.z();
}

std::optional<Eigen::Matrix3d> fit_homography(const std::vector<Eigen::Vector2d>& from, const std::vector<Eigen::Vector2d>& to) {
  VENATO_EXPECTS(from.size() == to.size() && from.size() >= 4);
  const auto n = static_cast<Eigen::Index>(from.size());
  const auto norm_from = normalising(from), norm_to = normalising(to);
  if (!norm_from || !norm_to) return std::nullopt;
  Eigen::MatrixXd a(2 * n, 8);
  Eigen::VectorXd b(2 * n);
  std::vector<Eigen::Vector2d> f, t;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Vector2d p = project(*norm_from, from[static_cast<std::size_t>(k)]), q = project(*norm_to, to[static_cast<std::size_t>(k)]);
    f.push_back(p), t.push_back(q);
    a.row(2 * k) << p.x(), p.y(), 1, 0, 0, 0, -q.x() * p.x(), -q.x() * p.y();
    a.row(2 * k + 1) << 0, 0, 0, p.x(), p.y(), 1, -q.y() * p.x(), -q.y() * p.y();
    b.segment<2>(2 * k) = q;
  }
  // The last element may be 1: a homography of points around the origin that sends the origin to infinity shows no slab.
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues();
  if (!(singular[7] > kWellPosed * singular[0])) return std::nullopt;
  Eigen::VectorXd h = a.colPivHouseholderQr().solve(b);
  for (int step = 0; n > 4 && step < kMostSteps; ++step) {  // the linear form weighs points by their depth; distances should count alike
    Eigen::MatrixXd jacobian(2 * n, 8);
    Eigen::VectorXd miss(2 * n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Vector2d &p = f[static_cast<std::size_t>(k)], &q = t[static_cast<std::size_t>(k)];
      const Eigen::Vector3d v = matrix(h) * p.homogeneous();
      const Eigen::Vector2d at = v.hnormalized();
      const Eigen::Vector3d weight = p.homogeneous() / v.z();
      jacobian.row(2 * k) << weight.transpose(), 0, 0, 0, -at.x() * weight.x(), -at.x() * weight.y();
      jacobian.row(2 * k + 1) << 0, 0, 0, weight.transpose(), -at.y() * weight.x(), -at.y() * weight.y();
      miss.segment<2>(2 * k) = q - at;
    }
    const Eigen::VectorXd change = jacobian.colPivHouseholderQr().solve(miss);
    if (!change.allFinite()) return std::nullopt;
    h += change;
    if (change.norm() < kDone * h.norm()) break;
  }
  if (!h.allFinite()) return std::nullopt;
  return Eigen::Matrix3d(norm_to->inverse() * matrix(h) * *norm_from);
}
}  // namespace venato::graphics
