#pragma once
/// Small, slow, obvious integrator of TWO free spheres (Hertz, tangential spring, no rolling friction), with the faults of known codes as switches.
/// It shares no code with the engine: a negative control is this integrator with one fault, put to the same check as the engine.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/vec3.h"

namespace venato::dem::slow {

enum class Sliding {
  spring_cut,       ///< no damping while it slips, spring cut to mu F_n: |F_t| = mu F_n (the engine's rule)
  damping_uncapped  ///< spring cut, damping added on top while it does not slip, sum not capped (LIGGGHTS)
};
struct PairModel {
  double young_eff = 0, shear_eff = 0, beta = 0, friction = 0;
  bool clamp = true;          ///< false: the normal force may pull
  double lever_share = 0.5;   ///< torque arm R - share * overlap; 0 = lever R, which does not keep angular momentum
  double damping_factor = 1;  ///< 2 / sqrt(5) = the linear-spring formula on a Hertz contact (MFIX)
  Sliding sliding = Sliding::spring_cut;
  bool rescale = true;  ///< spring force shrinks with the stiffness on unloading
};
struct FreeSphere {
  Vec3 x = Vec3::Zero(), v = Vec3::Zero(), w = Vec3::Zero(), force = Vec3::Zero(), torque = Vec3::Zero();
  double radius = 0, mass = 0;
  double inertia() const { return 0.4 * mass * radius * radius; }
};
struct Pair {
  PairModel model;
  FreeSphere a, b;
  Vec3 spring = Vec3::Zero();
  double k_t_before = 0, overlap = 0, normal = 0;
  double lowest_normal = 0, peak_overlap = 0, tangential_impulse = 0, normal_impulse = 0;
  bool touching = false;

  void forces(double dt) {
    a.force = b.force = a.torque = b.torque = Vec3::Zero();
    const Vec3 to_b = b.x - a.x;
    overlap = a.radius + b.radius - to_b.norm();
    touching = overlap > 0;
    if (!touching) {
      spring.setZero(), k_t_before = 0, normal = 0;
      return;
    }
    const Vec3 n = to_b.normalized(), n_half = (to_b - 0.5 * dt * (b.v - a.v)).normalized();
    const double r = a.radius * b.radius / (a.radius + b.radius), m = a.mass * b.mass / (a.mass + b.mass);
    const double k_n = 4.0 / 3 * model.young_eff * std::sqrt(r * overlap), k_t = 8 * model.shear_eff * std::sqrt(r * overlap);
    const double c = 2 * std::sqrt(5.0 / 6) * model.beta * model.damping_factor;
    normal = k_n * overlap + c * std::sqrt(1.5 * k_n * m) * (a.v - b.v).dot(n);
    if (model.clamp) normal = std::max(0.0, normal);
    const double arm_a = a.radius - model.lever_share * overlap, arm_b = b.radius - model.lever_share * overlap;
    const Vec3 u = a.v + a.w.cross(arm_a * n_half) - b.v + b.w.cross(arm_b * n_half), slide = u - u.dot(n_half) * n_half;
    const double size = spring.norm();
    spring -= spring.dot(n) * n;  // carried into the new plane, length kept
    if (spring.norm() > 0) spring *= size / spring.norm();
    if (model.rescale && k_t < k_t_before) spring *= k_t / k_t_before;
    spring -= k_t * dt * slide;
    k_t_before = k_t;
    const double cap = model.friction * std::max(0.0, normal);
    Vec3 f = spring;
    const bool slips = spring.norm() > cap;
    if (slips) f = spring *= cap / spring.norm();
    if (!slips) {
      f -= c * std::sqrt(k_t * m) * slide;
      if (model.sliding == Sliding::spring_cut && f.norm() > cap) f *= cap / f.norm();
    }
    a.force = f - normal * n, b.force = -a.force;
    a.torque = (arm_a * n).cross(f), b.torque = (arm_b * n).cross(f);
    lowest_normal = std::min(lowest_normal, normal), peak_overlap = std::max(peak_overlap, overlap);
    tangential_impulse += f.norm() * dt, normal_impulse += normal * dt;
  }
  void step(double dt) {
    for (FreeSphere* s : {&a, &b}) {
      s->v += 0.5 * dt / s->mass * s->force, s->w += 0.5 * dt / s->inertia() * s->torque;
      s->x += dt * s->v;
    }
    forces(dt);
    for (FreeSphere* s : {&a, &b}) s->v += 0.5 * dt / s->mass * s->force, s->w += 0.5 * dt / s->inertia() * s->torque;
  }
  /// Until they have met and parted; NaN velocities when they never do.
  void collide(double dt, int longest = 200000) {
    bool met = false;
    for (int k = 0; k < longest && !(met && !touching); ++k) step(dt), met = met || touching;
    if (!met || touching) a.v = b.v = Vec3::Constant(std::nan(""));
  }
  Vec3 angular_momentum() const { return a.mass * a.x.cross(a.v) + b.mass * b.x.cross(b.v) + a.inertia() * a.w + b.inertia() * b.w; }
};
}  // namespace venato::dem::slow
