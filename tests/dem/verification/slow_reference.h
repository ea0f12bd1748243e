#pragma once
/// Small, slow, obvious integrator of ONE sphere against fixed spheres or the plane z = 0. It shares no code with the engine: the tests use it where
/// no published number exists for the engine's variant, and to simulate faulty variants as negative controls.
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "base/vec3.h"

namespace venato::dem::slow {

struct Model {
  double young_eff = 0, shear_eff = 0;  ///< Y*, G* of the contact [Pa]
  double beta = 0, friction = 0, rolling_friction = 0, rolling_damping = 0;
  bool displacement_history = false;  ///< F = k_t(d) xi (creates energy) instead of incremental, shrunk on unloading
  bool half_step_normal = true;       ///< false: the standard scheme, history grows along the full-step normal
  bool cap_rolling_damping = true;    ///< false: spring torque capped, damping torque added on top of it until mobilised
  bool tangential_damping = true;
  bool twist = false;           ///< spring turned about the normal by half the sphere's spin about it (mean spin of the two bodies)
  bool rolling_spring = true;   ///< false: CDT, a constant torque against the spin
  double wall_lever_share = 0;  ///< torque arm on the plane R - share * overlap; 1 = lever R - d of some codes
  double torsion = 0;           ///< > 0: rolling torque not taken across the normal (friction about the normal as well)
};
struct Fixed {
  Vec3 centre = Vec3::Zero();
  double radius = 0;  ///< 0 = the plane z = 0
};
struct Memory {
  Vec3 spring = Vec3::Zero(), roll = Vec3::Zero();
  double k_t = 0, k_r = 0;
};
struct Body {
  Model model;
  std::vector<Fixed> fixed;
  double radius = 0, mass = 0;
  Vec3 gravity = Vec3::Zero(), x = Vec3::Zero(), v = Vec3::Zero(), w = Vec3::Zero(), force = Vec3::Zero(), torque = Vec3::Zero();
  std::vector<Memory> memory = {};
  int touching = 0;

  static Vec3 carried(const Vec3& a, const Vec3& n) {  // into the plane across n, length kept
    const Vec3 flat = a - a.dot(n) * n;
    return flat.norm() > 0 ? Vec3(flat * (a.norm() / flat.norm())) : flat;
  }
  Vec3 normal_to(const Fixed& f, const Vec3& at) const { return f.radius > 0 ? (f.centre - at).normalized() : Vec3(0, 0, -1); }

  void contact(const Fixed& f, Memory& h, double dt) {
    const double gap = f.radius > 0 ? (f.centre - x).norm() - radius - f.radius : x.z() - radius;
    if (gap >= 0) {
      h = Memory();
      return;
    }
    ++touching;
    const double d = -gap, r_eff = f.radius > 0 ? radius * f.radius / (radius + f.radius) : radius,
                 arm = radius - (f.radius > 0 ? .5 : model.wall_lever_share) * d;
    const double k_n = 4.0 / 3 * model.young_eff * std::sqrt(r_eff * d), k_t = 8 * model.shear_eff * std::sqrt(r_eff * d);
    const double c = 2 * std::sqrt(5.0 / 6) * model.beta;
    const Vec3 n = normal_to(f, x), across = model.half_step_normal ? normal_to(f, x - 0.5 * dt * v) : n;
    const double f_n = std::max(0.0, k_n * d + c * std::sqrt(1.5 * k_n * mass) * v.dot(n));
    const Vec3 u = v + w.cross(arm * across), slide = u - u.dot(across) * across;
    if (model.displacement_history && h.k_t > 0) h.spring *= k_t / h.k_t;
    if (!model.displacement_history && k_t < h.k_t) h.spring *= k_t / h.k_t;
    h.spring = carried(h.spring, n);
    if (model.twist) h.spring = Eigen::AngleAxisd(0.5 * w.dot(n) * dt, n) * h.spring;
    h.spring -= k_t * dt * slide;
    h.k_t = k_t;
    Vec3 f_t = h.spring;
    if (h.spring.norm() > model.friction * f_n) {
      f_t = h.spring *= model.friction * f_n / h.spring.norm();
    } else if (model.tangential_damping) {
      f_t -= c * std::sqrt(k_t * mass) * slide;
      if (f_t.norm() > model.friction * f_n) f_t *= model.friction * f_n / f_t.norm();
    }
    force += f_t - f_n * n;
    torque += (arm * n).cross(f_t);
    if (model.rolling_friction > 0) torque += rolling(h, n, k_n, r_eff, model.rolling_friction * r_eff * f_n, dt);
  }
  Vec3 rolling(Memory& h, const Vec3& n, double k_n, double r_eff, double limit, double dt) const {
    const Vec3 roll = w - (1 - model.torsion) * w.dot(n) * n;
    if (!model.rolling_spring) return roll.norm() > 0 ? Vec3(-limit / roll.norm() * roll) : Vec3(Vec3::Zero());
    const double k_r = 2.25 * k_n * std::pow(model.rolling_friction * r_eff, 2);
    if (k_r < h.k_r) h.roll *= k_r / h.k_r;
    h.roll = (model.torsion > 0 ? h.roll : carried(h.roll, n)) - k_r * dt * roll;
    h.k_r = k_r;
    if (h.roll.norm() > limit) return h.roll *= limit / h.roll.norm();
    const Vec3 m = h.roll - 2 * model.rolling_damping * std::sqrt(1.4 * mass * radius * radius * k_r) * roll;
    return model.cap_rolling_damping && m.norm() > limit ? Vec3(m * (limit / m.norm())) : m;
  }
  void forces(double dt) {
    memory.resize(fixed.size());
    force = mass * gravity, torque = Vec3::Zero(), touching = 0;
    for (std::size_t k = 0; k < fixed.size(); ++k) contact(fixed[k], memory[k], dt);
  }
  void step(double dt) {
    const double inertia = 0.4 * mass * radius * radius;
    v += 0.5 * dt / mass * force, w += 0.5 * dt / inertia * torque;
    x += dt * v;
    forces(dt);
    v += 0.5 * dt / mass * force, w += 0.5 * dt / inertia * torque;
  }
  double kinetic() const { return 0.5 * mass * v.squaredNorm() + 0.2 * mass * radius * radius * w.squaredNorm(); }
};
}  // namespace venato::dem::slow
