#pragma once
/// Scenes shared by the engine tests.
#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "dem/contact/kernels/mixing.h"
#include "dem/simulation/simulation.h"

namespace venato::dem::scene {

/// The powder of verification.md 0.4: E = 10 MPa, nu = 0.25, rho = 1900.
inline MaterialTable powder(double restitution = 0.5, double friction = 0.5, double rolling = 0.1, double rolling_damping = 0.3) {
  return {{{"grain", 1900, 1e7, 0.25}}, {{restitution, friction, rolling, rolling_damping}}};
}
inline SimulationSetup setup(double dt, const MaterialTable& materials = powder(), const Vec3& gravity = Vec3::Zero()) {
  SimulationSetup s;
  s.materials = materials;
  s.time_step_s = dt;
  s.gravity_m_s2 = gravity;
  return s;
}
inline GrainInput grain(const Vec3& position, double radius, const Vec3& velocity = Vec3::Zero(), const Vec3& spin = Vec3::Zero()) {
  GrainInput g;
  g.position_m = position;
  g.radius_m = radius;
  g.velocity_m_s = velocity;
  g.spin_rad_s = spin;
  return g;
}
inline Wall plane(const Vec3& point = Vec3::Zero(), const Vec3& normal = Vec3::UnitZ()) {
  Wall w;
  w.name = "plane";
  w.shape = PlaneShape{point, normal};
  return w;
}
inline Wall mesh(std::vector<Triangle> triangles) {
  Wall w;
  w.name = "mesh";
  w.shape = MeshShape{std::move(triangles)};
  return w;
}
/// Duration of an elastic Hertz contact (verification.md 0.4).
inline double hertz_time(double m_eff, double r_eff, double young_eff, double speed) {
  return 2.86828 * std::pow(m_eff * m_eff / (r_eff * young_eff * young_eff * speed), 0.2);
}

/// n polydisperse grains thrown into a box that is periodic along x and y, with a floor and a mesh ramp: rolling, sliding, pouring, resting.
inline Simulation heap(int n, SimulationSetup s, double ratio = 3) {
  const double r_max = 400e-6, r_min = r_max / ratio, pitch = 2.05 * r_max;
  const int side = std::max(3, static_cast<int>(std::cbrt(n / 2.0)));
  s.box.low = Vec3(0, 0, -1), s.box.high = Vec3(side * pitch, side * pitch, 1);
  s.box.periodic[0] = s.box.periodic[1] = true;
  s.gravity_m_s2 = Vec3(0, 0, -9.81);
  Simulation sim(s);
  sim.add_wall(plane());
  const double w = side * pitch;
  sim.add_wall(mesh({{{0, 0.2 * w, 0}, {w, 0.2 * w, 0}, {w, 0.6 * w, 0.4 * w}}, {{0, 0.2 * w, 0}, {w, 0.6 * w, 0.4 * w}, {0, 0.6 * w, 0.4 * w}}}));
  Rng rng(7, 3);
  for (int k = 0, level = 0; k < n; ++level)
    for (int y = 0; y < side && k < n; ++y)
      for (int x = 0; x < side && k < n; ++x, ++k) {
        const double u = rng.uniform(), radius = r_min + (r_max - r_min) * u * u;
        const Vec3 v(rng.uniform() - 0.5, rng.uniform() - 0.5, -0.5 - 0.5 * rng.uniform());
        sim.add_grain(grain(Vec3((x + 0.5) * pitch, (y + 0.5) * pitch, 0.45 * w + (level + 0.5) * pitch), radius, v));
      }
  return sim;
}
}  // namespace venato::dem::scene
