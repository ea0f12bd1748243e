#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "dem/vtk/vtk_writer.h"

namespace venato::dem {
namespace {
constexpr int kFacets = 64;  // a cylinder that looks round; display only

/// Two unit vectors that make a right-handed frame with `n`.
std::array<Vec3, 2> across(const Vec3& n) {
  const Vec3 helper = std::abs(n.z()) < 0.9 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX());
  const Vec3 u = helper.cross(n).normalized();
  return {u, n.cross(u)};
}

std::vector<Triangle> cylinder_triangles(const CylinderShape& cylinder) {
  const Vec3 axis = cylinder.axis.normalized(), top = cylinder.length_m * axis;
  const auto [u, v] = across(axis);
  std::vector<Triangle> out;
  const auto rim = [&, u = u, v = v](int k) -> Vec3 {
    const double angle = 2 * std::numbers::pi * (k % kFacets) / kFacets;
    return cylinder.base + cylinder.radius_m * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int k = 0; k < kFacets; ++k) {
    const Vec3 a = rim(k), b = rim(k + 1);
    out.push_back({a, b, b + top});
    out.push_back({a, b + top, a + top});
  }
  return out;
}

std::vector<Triangle> plane_triangles(const PlaneShape& plane, const Box& box) {
  const Vec3 n = plane.normal.normalized();
  const Vec3 margin = 1e-9 * (box.high - box.low);  // a plane that is a face of the box still cuts it
  const Vec3 low = box.low - margin, high = box.high + margin;
  const auto corner = [&](int k) { return Vec3(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z()); };
  std::vector<Vec3> points;
  for (int a = 0; a < 8; ++a)
    for (int bit = 1; bit < 8; bit <<= 1) {
      if (a & bit) continue;
      const Vec3 p = corner(a), q = corner(a | bit);
      const double dp = n.dot(p - plane.point), dq = n.dot(q - plane.point);
      if ((dp < 0) == (dq < 0)) continue;
      points.push_back(p + dp / (dp - dq) * (q - p));
    }
  if (points.size() < 3) return {};
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : points) centre += p / static_cast<double>(points.size());
  const auto [u, v] = across(n);
  std::sort(points.begin(), points.end(), [&, u = u, v = v](const Vec3& p, const Vec3& q) {
    return std::atan2(v.dot(p - centre), u.dot(p - centre)) < std::atan2(v.dot(q - centre), u.dot(q - centre));
  });
  std::vector<Triangle> out;
  for (std::size_t k = 1; k + 1 < points.size(); ++k) out.push_back({points[0], points[k], points[k + 1]});
  return out;
}
}  // namespace

std::vector<Triangle> tessellate(const WallShape& shape, const Box& box) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) return mesh->triangles;
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) return cylinder_triangles(*cylinder);
  return plane_triangles(std::get<PlaneShape>(shape), box);
}
}  // namespace venato::dem
