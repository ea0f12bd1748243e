#pragma once
/// Scenes of the physics verification: single spheres and pairs. Expected numbers come from the published cases named in the tests.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "dem/contact/kernels/mixing.h"
#include "dem/simulation/simulation.h"
#include "tests/dem/engine/scene.h"

namespace venato::dem::verification {

/// A solid sphere: E [Pa], nu, density [kg/m3], radius [m].
struct Ball {
  double young, poisson, density, radius;
  double mass() const { return 4.0 / 3 * std::numbers::pi * radius * radius * radius * density; }
  double plane_modulus() const { return young / (1 - poisson * poisson); }  ///< Y* against a rigid wall; half of it against its like
  Material material() const { return {"ball", density, young, poisson}; }
};
inline const Ball kAluminiumOxide{3.8e11, .23, 4000, 2.5e-3};  ///< Chung & Ooi tests 3 and 4
inline const Ball kAluminiumAlloy{7e10, .33, 2700, .1};        ///< Chung & Ooi tests 6, 7, 8

/// Material 0 = the ball, material 1 = a rigid wall (1e30 Pa adds 1e-19 to the compliance); one set of properties for every pair.
inline MaterialTable on_rigid(const Ball& b, const PairProperties& p) { return {{b.material(), {"rigid", 1, 1e30, 0.3}}, {p, p, p, p}}; }
inline MaterialTable alone(const Ball& b, const PairProperties& p) { return {{b.material()}, {p}}; }

/// Hertz without damping: greatest overlap and duration.
inline double hertz_overlap(double m_eff, double r_eff, double young_eff, double speed) {
  return std::pow(15 * m_eff * speed * speed / (16 * young_eff * std::sqrt(r_eff)), 0.4);
}
inline double hertz_duration(double m_eff, double r_eff, double young_eff, double speed) {
  return 2.9432 * hertz_overlap(m_eff, r_eff, young_eff, speed) / speed;
}
/// Overlap of a sphere that presses with `force` on a rigid plane.
inline double static_overlap(const Ball& b, double force) { return std::pow(3 * force / (4 * b.plane_modulus() * std::sqrt(b.radius)), 2.0 / 3); }

inline Wall rigid_plane() {
  Wall w = scene::plane();
  w.material = 1;
  return w;
}

struct Impact {
  GrainState a, b;  ///< after; b only for pairs
  double peak_force = 0, peak_overlap = 0;
  double duration = 0;   ///< time with overlap
  double push_time = 0;  ///< time with a normal force > 0 (shorter when damping is clamped)
  double tangential_impulse = 0, normal_impulse = 0;
};
/// Steps until the one contact of the scene has come and gone.
inline Impact collide(Simulation& sim, std::int64_t longest = 200000) {
  Impact r;
  bool met = false;
  for (std::int64_t k = 0; k < longest; ++k) {
    sim.step();
    const auto contacts = sim.contacts();
    if (contacts.empty()) {
      if (met) break;
      continue;
    }
    met = true;
    const ContactState& c = contacts.front();
    r.peak_force = std::max(r.peak_force, c.normal_force_n);
    r.peak_overlap = std::max(r.peak_overlap, c.overlap_m);
    r.duration += sim.time_step_s();
    if (c.normal_force_n > 0) r.push_time += sim.time_step_s();
    r.normal_impulse += c.normal_force_n * sim.time_step_s();
    r.tangential_impulse += c.tangential_force_n.norm() * sim.time_step_s();
  }
  if (!met || !sim.contacts().empty()) r.duration = std::nan("");  // never met or never parted: every expectation fails
  r.a = sim.grain(0);
  if (sim.has_grain(1)) r.b = sim.grain(1);
  return r;
}

/// One sphere against the rigid plane z = 0 with velocity (v_t, 0, -v_n) and spin (0, spin, 0); its surface slides with v_t - R spin.
/// `phase` in (0, 1]: part of a step before first touch.
inline Impact hit_plane(const Ball& b, const PairProperties& p, double v_n, double v_t, double spin, int steps_per_contact, double phase = 0.37) {
  const double dt = hertz_duration(b.mass(), b.radius, b.plane_modulus(), v_n) / steps_per_contact;
  Simulation sim(scene::setup(dt, on_rigid(b, p)));
  sim.add_wall(rigid_plane());
  sim.add_grain(scene::grain(Vec3(0, 0, b.radius + phase * v_n * dt), b.radius, Vec3(v_t, 0, -v_n), Vec3(0, spin, 0)));
  return collide(sim);
}
}  // namespace venato::dem::verification
