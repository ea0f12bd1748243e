/// Damped Hertz (Antypov & Elliott 2011) for pairs: every row of the dimensionless table, equal and 8:1 radii, and the faulty variants of the damping
/// that known codes have, put to the same checks. The wall column of the table is in normal_impact_test.cpp.
#include <gtest/gtest.h>

#include "tests/dem/verification/scenes.h"
#include "tests/dem/verification/slow_pair.h"

namespace venato::dem::verification {
namespace {
/// Textbook e, then of the clamped law (F >= 0) with that damping: greatest overlap and time under load over the elastic ones, measured restitution.
/// Computed by an independent integrator, five digits.
constexpr double kTable[][4] = {{.98, .99198, .99156, .98008}, {.95, .97990, .98304, .95051}, {.9, .95959, .97112, .90203},
                                {.8, .91830, .95017, .80810},  {.7, .87599, .93046, .71820},  {.6, .83247, .91083, .63229},
                                {.5, .78747, .89062, .55028},  {.45, .76430, .88013, .51070}, {.4, .74060, .86927, .47201},
                                {.3, .69116, .84607, .39714},  {.2, .63779, .81989, .32486},  {.1, .57685, .78803, .25273},
                                {.05, .53941, .76716, .21370}};
/// 2e-3: 2000 steps per contact leave 3e-4 (first order in the step, damped).
constexpr double kTolerance = 2e-3;
bool restitution_is(double measured, double asked) { return std::abs(measured - asked) <= kTolerance; }

struct Two {
  Ball ball;
  double radius_b, speed;
  double m_a() const { return ball.mass(); }
  double m_b() const { return ball.mass() * std::pow(radius_b / ball.radius, 3); }
  double m_eff() const { return m_a() * m_b() / (m_a() + m_b()); }
  double r_eff() const { return ball.radius * radius_b / (ball.radius + radius_b); }
  double y_eff() const { return ball.plane_modulus() / 2; }
  double overlap() const { return hertz_overlap(m_eff(), r_eff(), y_eff(), speed); }
  double duration() const { return hertz_duration(m_eff(), r_eff(), y_eff(), speed); }
};
/// Sizes, stiffnesses, densities and speeds have no say.
const Two kPairs[] = {{{1e7, .25, 1900, 2e-4}, 2e-4, .1}, {{1e7, .25, 1900, 8e-4}, 1e-4, .02}, {{7e10, .33, 2700, 1e-2}, 8e-2, 3}};

TEST(DampedHertz, EveryRowForEqualAndUnequalPairs) {
  for (const Two& two : kPairs)
    for (const auto& row : kTable) {
      const double dt = two.duration() / 2000;
      Simulation sim(scene::setup(dt, alone(two.ball, {row[3], .5, .1, .3})));
      sim.add_grain(scene::grain(Vec3(0, 0, 0), two.ball.radius, Vec3(.7 * two.speed, 0, 0)));
      sim.add_grain(scene::grain(Vec3(two.ball.radius + two.radius_b + .37 * two.speed * dt, 0, 0), two.radius_b, Vec3(-.3 * two.speed, 0, 0)));
      const Impact hit = collide(sim);
      EXPECT_TRUE(restitution_is((hit.b.velocity_m_s - hit.a.velocity_m_s).x() / two.speed, row[3])) << row[3] << " at radius " << two.radius_b;
      EXPECT_NEAR(hit.peak_overlap / two.overlap(), row[1], kTolerance) << row[3] << " at radius " << two.radius_b;
      EXPECT_NEAR(hit.push_time / two.duration(), row[2], kTolerance) << row[3] << " at radius " << two.radius_b;
    }
}
/// No contact pulls, at no step, for no damping: pair and wall, head-on and oblique. The force, not only the number reported.
TEST(DampedHertz, TheNormalForceNeverPulls) {
  int pushes = 0;
  for (const double e : {.02, .1, .5, .95})
    for (const bool wall : {false, true}) {
      const Ball ball{1e7, .25, 1900, 2e-4};
      Simulation sim(scene::setup(5e-8, on_rigid(ball, {e, .5, .1, .3})));
      sim.add_grain(scene::grain(Vec3(0, 0, 2.001e-4), 2e-4, Vec3(.1, 0, -.5)));
      if (wall)
        sim.add_wall(rigid_plane());
      else
        sim.add_grain(scene::grain(Vec3(1e-4, 0, -1.9e-4), 2.5e-4));
      for (int k = 0; k < 3000; ++k) {
        sim.step();
        for (const ContactState& c : sim.contacts()) {
          ASSERT_GE(c.normal_force_n, 0);
          ASSERT_LE(c.force_n.dot(c.normal), 1e-15 * c.force_n.norm());  // rounding of the projection
          pushes += c.normal_force_n > 0;
        }
      }
      EXPECT_TRUE(sim.contacts().empty());
    }
  EXPECT_GT(pushes, 1000);
}

slow::Pair head_on(const Two& two, double beta) {
  slow::Pair p;
  p.model.young_eff = two.y_eff(), p.model.beta = beta;
  p.a.radius = two.ball.radius, p.b.radius = two.radius_b, p.a.mass = two.m_a(), p.b.mass = two.m_b();
  p.a.v = Vec3(two.speed, 0, 0), p.b.x = Vec3(two.ball.radius + two.radius_b + .37 * two.speed * two.duration() / 2000, 0, 0);
  return p;
}
double textbook(double e) { return -std::log(e) / std::hypot(std::log(e), std::numbers::pi); }
/// Negative controls with the input e = .5: the textbook damping with a clamped force rebounds with .55028, the linear-spring damping formula (factor
/// 2 instead of sqrt 5) with .5396 (published values, 1e-3), and the textbook damping without a clamp, though right in e, pulls.
TEST(DampedHertz, FaultyDampingsAreRejected) {
  for (const Two& two : kPairs) {
    const double dt = two.duration() / 2000;
    slow::Pair clamped = head_on(two, textbook(.5)), linear = clamped, unclamped = clamped;
    linear.model.damping_factor = 2 / std::sqrt(5.), linear.model.clamp = false, unclamped.model.clamp = false;
    clamped.collide(dt), linear.collide(dt), unclamped.collide(dt);
    auto e = [&](const slow::Pair& p) { return (p.b.v - p.a.v).x() / two.speed; };
    EXPECT_NEAR(e(clamped), .55028, 1e-3);
    EXPECT_FALSE(restitution_is(e(clamped), .5));
    EXPECT_NEAR(e(linear), .5396, 1e-3);
    EXPECT_FALSE(restitution_is(e(linear), .5));
    EXPECT_TRUE(restitution_is(e(unclamped), .5));
    EXPECT_EQ(clamped.lowest_normal, 0);
    EXPECT_LT(unclamped.lowest_normal, -.01 * two.y_eff() * std::sqrt(two.r_eff()) * std::pow(two.overlap(), 1.5));
  }
}
}  // namespace
}  // namespace venato::dem::verification
