/// Coarse graining: grains cg times as large with the same E, nu, rho, e, mu, mu_r are the same mechanics in units of the radius. cg = 2 and 4 only
/// shift binary exponents; 3 makes sure that rounding is not what agrees. Limits 1e-10 of each quantity for impacts (1500 steps), 1e-9 for 10^5 steps
/// of rolling.
#include <gtest/gtest.h>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFactors[] = {2, 3, 4};

Ball scaled(Ball b, double cg) {
  b.radius *= cg;
  return b;
}
/// What must not depend on cg: e, velocities after, overlap / R, time / (R / v), R w / v, force / R^2.
struct Signature {
  double e, v_t, spin, overlap, duration, force;
};
void expect_same(const Signature& a, const Signature& b, double limit, const char* what, double cg) {
  EXPECT_NEAR(a.e / b.e, 1, limit) << what << " cg " << cg;
  EXPECT_NEAR(a.v_t, b.v_t, limit) << what << " cg " << cg;
  EXPECT_NEAR(a.spin, b.spin, limit) << what << " cg " << cg;
  EXPECT_NEAR(a.overlap / b.overlap, 1, limit) << what << " cg " << cg;
  EXPECT_NEAR(a.duration / b.duration, 1, limit) << what << " cg " << cg;
  EXPECT_NEAR(a.force / b.force, 1, limit) << what << " cg " << cg;
}
const Ball kPowder{1e7, .25, 1900, 2e-4};

Signature on_plane(double cg, const PairProperties& p, double degrees, double phase_shift = 0) {
  const Ball b = scaled(kPowder, cg);
  const double v = .8, v_n = v * std::cos(degrees * kDegree);
  const Impact hit = hit_plane(b, p, v_n, v * std::sin(degrees * kDegree), 0, 1500, .37 + phase_shift);
  return {hit.a.velocity_m_s.z() / v_n, hit.a.velocity_m_s.x() / v,  hit.a.spin_rad_s.y() * b.radius / v,
          hit.peak_overlap / b.radius,  hit.duration * v / b.radius, hit.peak_force / (b.radius * b.radius)};
}
/// (a) impacts on a plane, (b) oblique at 5, 15, 45 deg with sliding and rolling friction.
TEST(Invariance, ImpactsOnAPlane) {
  for (const double e : {1., .5, .2})
    for (const double degrees : {0., 5., 15., 45.}) {
      const PairProperties p{e, .4, .1, .3};
      const Signature one = on_plane(1, p, degrees);
      for (const double cg : kFactors) expect_same(on_plane(cg, p, degrees), one, 1e-10, "plane", cg);
      EXPECT_GT(one.overlap, .015);  // deep enough that a term which does not scale would show
    }
}
/// Unequal pair with spins, off centre.
TEST(Invariance, UnequalPair) {
  auto run = [](double cg) {
    const double dt = 2e-8 * cg, v = .5;
    Simulation sim(scene::setup(dt, alone(kPowder, {.6, .5, .1, .3})));
    sim.add_grain(scene::grain(Vec3(0, 0, 0), cg * 2e-4, Vec3(.3, .1, -.05), Vec3(100, -300, 200) / cg));
    sim.add_grain(scene::grain(cg * Vec3(4.1e-4, 3.2e-4, 1e-4), cg * 3e-4, Vec3(-.2, 0, .02), Vec3(-50, 20, 80) / cg));
    const Impact hit = collide(sim);
    return Signature{hit.a.velocity_m_s.norm() / v, hit.a.velocity_m_s.y() / v, hit.a.spin_rad_s.z() * cg / 200,
                     hit.peak_overlap / cg,         hit.duration / cg,          hit.peak_force / (cg * cg)};
  };
  for (const double cg : kFactors) expect_same(run(cg), run(1), 1e-10, "pair", cg);
}
/// Negative control: a different phase of first touch inside the step is seen at this limit, and so is a change of E by 1e-8.
TEST(Invariance, TheLimitIsSharp) {
  const PairProperties p{.5, .4, .1, .3};
  EXPECT_GT(std::abs(on_plane(1, p, 15, 1e-3).overlap / on_plane(1, p, 15).overlap - 1), 1e-10);
  Ball stiff = kPowder;
  stiff.young *= 1 + 1e-8;
  EXPECT_GT(std::abs(hit_plane(stiff, p, .8, 0, 0, 1500).peak_force / hit_plane(kPowder, p, .8, 0, 0, 1500).peak_force - 1), 1e-9);
}

struct RollOut {
  double time, way, spin;
};
/// Rolling to rest; `g` as given.
RollOut roll_out(const Ball& b, double v0, double g, double mu_r, double dt, std::int64_t steps) {
  Simulation sim(scene::setup(dt, on_rigid(b, {.5, .5, mu_r, .3}), Vec3(0, 0, -g)));
  sim.add_wall(rigid_plane());
  sim.add_grain(scene::grain(Vec3(0, 0, b.radius - static_overlap(b, b.mass() * g)), b.radius, Vec3(v0, 0, 0), Vec3(0, v0 / b.radius, 0)));
  RollOut r{0, 0, 0};
  for (std::int64_t k = 0; k < steps; ++k) {
    sim.step();
    const GrainState s = sim.grain(0);
    if (r.time == 0 && s.velocity_m_s.x() <= 0) r.time = sim.time_s(), r.way = s.position_m.x();
    if (k == steps / 3) r.spin = s.spin_rad_s.y();
  }
  return r;
}
/// (c) EPSD run with v0^2 / (g R) fixed (g / cg): the same run in units of R and v.
TEST(Invariance, RollingWithScaledGravity) {
  const Ball bead{1e7, .25, 2500, 1e-3};
  const double v0 = .02, dt = 1e-6;
  const RollOut one = roll_out(bead, v0, 9.81, .1, dt, 40000);
  for (const double cg : kFactors) {
    const RollOut r = roll_out(scaled(bead, cg), v0, 9.81 / cg, .1, dt * cg, 40000);
    EXPECT_NEAR(r.time / cg / one.time, 1, 1e-9) << cg;
    EXPECT_NEAR(r.way / cg / one.way, 1, 1e-9) << cg;
    EXPECT_NEAR(r.spin * cg / one.spin, 1, 1e-9) << cg;
  }
  EXPECT_NEAR(one.time, 7 * v0 / (5 * .1 * 9.81), .05 * one.time);  // it did stop
  // Negative control: mu_r given as a length (mu_r R kept, so mu_r / cg) is not invariant; neither is gravity left as it is.
  const RollOut as_length = roll_out(scaled(bead, 2), v0, 9.81 / 2, .1 / 2, dt * 2, 40000),
                heavy = roll_out(scaled(bead, 2), v0, 9.81, .1, dt * 2, 40000);
  EXPECT_GT(std::abs(as_length.spin * 2 / one.spin - 1), 1e-2);
  EXPECT_GT(std::abs(heavy.spin * 2 / one.spin - 1), 1e-2);
}
/// (d) gravity as it is: the stop laws 7 v0 / (5 mu_r g) and 7 v0^2 / (10 mu_r g) do not know the radius. 0.5 %: not self-similar, the overlap grows
/// with cg.
TEST(Invariance, StopLawWithRealGravity) {
  const double v0 = .15, g = 9.81, mu_r = .1;
  for (const double cg : {1., 2., 4.}) {
    const RollOut r = roll_out(scaled({1e7, .25, 2500, 5e-4}, cg), v0, g, mu_r, 4e-6, 58000);
    EXPECT_NEAR(r.time / (7 * v0 / (5 * mu_r * g)), 1, 5e-3) << cg;
    EXPECT_NEAR(r.way / (7 * v0 * v0 / (10 * mu_r * g)), 1, 5e-3) << cg;
  }
}

/// (e) Simple cubic block pressed between its first and last layer by a strain of 1e-3: stress = E eps^1.5 / (3 (1 - nu^2)) = 112.44 Pa for any grain
/// size. Free layers in between find their places by themselves. 0.1 %.
TEST(Block, SimpleCubicStress) {
  for (const double r : {1e-4, 4e-4, 1.6e-3}) {
    const int side = 3, layers = 5;
    const double pitch = 2 * r * (1 - 1e-3), dt = 2e-6 * r / 1e-4;
    SimulationSetup s = scene::setup(dt, alone({1e7, .25, 1900, r}, {.1, 0, 0, 0}));
    s.box.high = Vec3(side * 2.001 * r, side * 2.001 * r, 1);  // a hair apart across: loaded along z alone
    s.box.periodic[0] = s.box.periodic[1] = true;
    Simulation sim(s);
    for (int k = 0; k < layers; ++k)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const double off = k > 0 && k < layers - 1 ? 2e-4 * r * (k - 2.2) : 0;  // not where they belong
          GrainInput g = scene::grain(Vec3((x + .5) * 2.001 * r, (y + .5) * 2.001 * r, k * pitch + off), r);
          g.frozen = k == 0 || k == layers - 1;
          sim.add_grain(g);
        }
    sim.step(4000);
    double force = 0;
    for (const ContactState& c : sim.contacts())
      if (c.i < side * side) force += c.normal_force_n * c.normal.z();
    EXPECT_NEAR(force / (side * side * 4 * r * r) / 112.44, 1, 1e-3) << r;
    EXPECT_EQ(sim.contacts().size(), static_cast<std::size_t>(side * side * (layers - 1)));
  }
}
}  // namespace
}  // namespace venato::dem::verification
