#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "dem/case.h"

namespace venato::dem {

MeshShape make_ring(const Vec3& centre, const Vec3& normal, double inner_radius_m, double outer_radius_m, int segments) {
  if (!(normal.norm() > 0) || !normal.allFinite() || !centre.allFinite())
    throw UsageError("a ring needs a finite centre and a normal that is not zero");
  if (!(inner_radius_m >= 0) || !(outer_radius_m > inner_radius_m) || !std::isfinite(outer_radius_m))
    throw UsageError("a ring needs 0 <= inner radius < outer radius");
  if (segments < 8) throw UsageError("a ring needs at least 8 segments");
  const Vec3 n = normal.normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  // The polygon of the hole gets the area of the circle: flow goes with the area first.
  const double step = 2 * std::numbers::pi / segments, grow = std::sqrt(step / std::sin(step));
  const auto at = [&](double radius, int k) {
    return Vec3(centre + radius * (std::cos(k % segments * step) * u + std::sin(k % segments * step) * v));
  };
  MeshShape mesh;
  for (int k = 0; k < segments; ++k) {
    const Vec3 a = at(outer_radius_m * grow, k), b = at(outer_radius_m * grow, k + 1);
    if (inner_radius_m == 0) {
      mesh.triangles.push_back({centre, a, b});
      continue;
    }
    const Vec3 c = at(inner_radius_m * grow, k), d = at(inner_radius_m * grow, k + 1);
    mesh.triangles.push_back({c, a, b});
    mesh.triangles.push_back({c, b, d});
  }
  return mesh;
}
}  // namespace venato::dem
