#include <cmath>
#include <string>

#include "base/error.h"
#include "dem/case.h"

namespace venato::dem {

MeshShape extrude_profile(const std::vector<std::pair<double, double>>& yz_m, double x_low_m, double x_high_m) {
  if (yz_m.size() < 2) throw UsageError("a wall profile needs at least 2 (y, z) points, has " + std::to_string(yz_m.size()));
  if (!std::isfinite(x_low_m) || !std::isfinite(x_high_m) || !(x_high_m > x_low_m))
    throw UsageError("a wall profile is extruded from x_low to x_high > x_low, got " + std::to_string(x_low_m) + " and " + std::to_string(x_high_m) +
                     " m");
  MeshShape mesh;
  mesh.triangles.reserve(2 * (yz_m.size() - 1));
  for (std::size_t k = 0; k + 1 < yz_m.size(); ++k) {
    const auto [y0, z0] = yz_m[k];
    const auto [y1, z1] = yz_m[k + 1];
    const double length = std::hypot(y1 - y0, z1 - z0);
    if (!std::isfinite(length))
      throw UsageError("wall profile: point " + std::to_string(k) + " or " + std::to_string(k + 1) + " is not a finite (y, z) pair");
    if (!(length > 0)) throw UsageError("wall profile: points " + std::to_string(k) + " and " + std::to_string(k + 1) + " coincide");
    const Vec3 a(x_low_m, y0, z0), b(x_high_m, y0, z0), c(x_high_m, y1, z1), d(x_low_m, y1, z1);
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}
}  // namespace venato::dem
