#pragma once
/// Scenes of the bulk laws. Grains of 4 mm: laws are in diameters, and the number of steps falls with the square root of the size.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/rng.h"
#include "dem/simulation/simulation.h"

namespace venato::dem::bulk {

inline constexpr double kD = 4e-3, kDensity = 2000, kGravity = 9.81;
/// 18 % of the Rayleigh time of the smallest grain (1.8 mm, E = 10 MPa).
inline constexpr double kStep = 2.5e-5;

/// Material 0 = grains, 1 = walls.
inline MaterialTable powder(double friction, double rolling, double wall_friction, double restitution = 0.5) {
  const PairProperties grains{restitution, friction, rolling, 0.3}, walls{restitution, wall_friction, rolling, 0.3};
  return {{{"grain", kDensity, 1e7, 0.25}, {"wall", kDensity, 1e8, 0.25}}, {grains, walls, walls, walls}};
}
inline SimulationSetup setup(const MaterialTable& materials, const Vec3& box_high, bool periodic_x, bool periodic_y,
                             const Vec3& gravity = Vec3(0, 0, -kGravity)) {
  SimulationSetup s;
  s.materials = materials;
  s.time_step_s = kStep;
  s.gravity_m_s2 = gravity;
  s.box.low = Vec3(0, 0, -1), s.box.high = box_high;
  s.box.periodic[0] = periodic_x, s.box.periodic[1] = periodic_y;
  return s;
}
inline Wall wall(WallShape shape) {
  Wall w;
  w.shape = std::move(shape);
  w.material = 1;
  return w;
}
inline Wall plane(const Vec3& point, const Vec3& normal) { return wall(PlaneShape{point, normal}); }
/// Diameter kD (1 +- 0.1), mean kD by number.
inline GrainInput sphere(const Vec3& at, Rng& rng) {
  GrainInput g;
  g.position_m = at;
  g.radius_m = 0.5 * kD * (0.9 + 0.2 * rng.uniform());
  return g;
}
/// Loose lattice of n grains from `low` upwards, filling low.xy … high.xy; `keep` says which sites are used.
template <class Keep>
void pour(Simulation& sim, int n, const Vec3& low, const Vec3& high, std::uint64_t seed, const Keep& keep) {
  const double pitch = 1.13 * kD;
  const int nx = std::max(1, static_cast<int>((high.x() - low.x()) / pitch)), ny = std::max(1, static_cast<int>((high.y() - low.y()) / pitch));
  const double px = (high.x() - low.x()) / nx, py = (high.y() - low.y()) / ny;
  Rng rng(seed, stream_id("tests/bulk_laws/pour"));
  for (int k = 0, layer = 0; k < n; ++layer)
    for (int iy = 0; iy < ny && k < n; ++iy)
      for (int ix = 0; ix < nx && k < n; ++ix) {
        const Vec3 jitter = 0.02 * kD * Vec3(rng.uniform() - .5, rng.uniform() - .5, rng.uniform() - .5);
        const Vec3 at = Vec3(low.x() + (ix + .5) * px, low.y() + (iy + .5) * py, low.z() + (layer + .6) * pitch) + jitter;
        if (!keep(at)) continue;
        sim.add_grain(sphere(at, rng));
        ++k;
      }
}
inline void pour(Simulation& sim, int n, const Vec3& low, const Vec3& high, std::uint64_t seed) {
  pour(sim, n, low, high, seed, [](const Vec3&) { return true; });
}
inline double fastest(const Simulation& sim) {
  double v = 0;
  for (const GrainState& g : sim.grains()) v = std::max(v, g.velocity_m_s.norm());
  return v;
}
inline double mean_speed(const Simulation& sim) {
  double v = 0;
  for (const GrainState& g : sim.grains()) v += g.velocity_m_s.norm() / static_cast<double>(sim.grain_count());
  return v;
}
inline double top(const Simulation& sim) {
  double z = -1e9;
  for (const GrainState& g : sim.grains()) z = std::max(z, g.position_m.z());
  return z;
}
inline double mass(const Simulation& sim) {
  double m = 0;
  for (const GrainState& g : sim.grains()) m += g.frozen ? 0 : g.mass_kg;
  return m;
}

struct Line {
  double intercept, slope, r2;
};
/// Least squares y = intercept + slope x.
inline Line fit(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) sx += x[k], sy += y[k], sxx += x[k] * x[k], sxy += x[k] * y[k], syy += y[k] * y[k];
  const double cxx = sxx - sx * sx / n, cxy = sxy - sx * sy / n, cyy = syy - sy * sy / n;
  return {(sy - cxy / cxx * sx) / n, cxy / cxx, cxy * cxy / (cxx * cyy)};
}
}  // namespace venato::dem::bulk
