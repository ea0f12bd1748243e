/// Head-on collisions against published values: Chung & Ooi (2011) tests 1-3, damped Hertz (Antypov & Elliott 2011), rest, order, drift.
#include <gtest/gtest.h>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {

/// Chung & Ooi test 1: two equal spheres at +-10 m/s, e = 1. The numbers are the Hertz solution (overlap = approach of the centres); 0.3 % is the
/// band other codes are held to, the engine at 2000 steps per contact is far inside. Velocities swap: 1e-4.
TEST(ChungOoi, Test1TwoEqualSpheres) {
  struct Row {
    Ball ball;
    double force, overlap, duration;
  };
  for (const Row& row :
       {Row{{4.8e10, .20, 2800, .01}, 10696.9, 2.74113e-4, 4.03397e-5}, Row{{2.0e10, .25, 2500, .01}, 7108.24, 3.68304e-4, 5.42013e-5}}) {
    const double m = row.ball.mass(), dt = row.duration / 2000;
    Simulation sim(scene::setup(dt, alone(row.ball, {1, .35, 0, 0})));
    sim.add_grain(scene::grain(Vec3(0, 0, 0), .01, Vec3(10, 0, 0)));
    sim.add_grain(scene::grain(Vec3(.02 + 7.4 * dt, 0, 0), .01, Vec3(-10, 0, 0)));
    const Impact hit = collide(sim);
    EXPECT_NEAR(hit.peak_force / row.force, 1, 3e-3);
    EXPECT_NEAR(hit.peak_overlap / row.overlap, 1, 3e-3);
    EXPECT_NEAR(hit.duration / row.duration, 1, 3e-3);
    EXPECT_NEAR(hit.a.velocity_m_s.x(), -10, 1e-3);
    EXPECT_NEAR(hit.b.velocity_m_s.x(), 10, 1e-3);
    EXPECT_NEAR(0.4 * hit.peak_force * hit.peak_overlap / (0.5 * m / 2 * 20 * 20), 1, 1e-4);  // all energy in the spring; peak missed by < dt / 2
  }
}
/// Chung & Ooi test 2: sphere on a rigid plane at 0.2 m/s, e = 1. As above.
TEST(ChungOoi, Test2SphereOnRigidPlane) {
  struct Row {
    Ball ball;
    double force, overlap, duration;
  };
  for (const Row& row : {Row{{7e10, .30, 2699, .1}, 11369.9, 4.97172e-5, 7.31660e-4}, Row{{4e10, .35, 1800, .1}, 7232.68, 5.21233e-5, 7.67070e-4}}) {
    const Impact hit = hit_plane(row.ball, {1, .35, 0, 0}, .2, 0, 0, 2000);
    EXPECT_NEAR(hit.peak_force / row.force, 1, 3e-3);
    EXPECT_NEAR(hit.peak_overlap / row.overlap, 1, 3e-3);
    EXPECT_NEAR(hit.duration / row.duration, 1, 3e-3);
    EXPECT_NEAR(hit.a.velocity_m_s.z(), .2, .2e-4);
    EXPECT_NEAR(0.4 * hit.peak_force * hit.peak_overlap / (0.5 * row.ball.mass() * .04), 1, 1e-4);
  }
}

/// Chung & Ooi test 3: aluminium oxide at 3.9 m/s. The engine solves its damping so that the measured restitution of the clamped law (F >= 0) IS the
/// input. Second and third column: greatest overlap and time under load of the clamped law, over the elastic ones, for the damping that belongs to
/// that restitution (table of damped Hertz, 5 digits). 2e-3 is asked for; 2000 steps per contact leave some 3e-4 (first order, see ErrorFalls...).
TEST(ChungOoi, Test3RestitutionSweep) {
  const Impact elastic = hit_plane(kAluminiumOxide, {1, .092, 0, 0}, 3.9, 0, 0, 2000);
  EXPECT_NEAR(elastic.peak_overlap / 8.08881e-6, 1, 2e-3);
  EXPECT_NEAR(elastic.peak_force / 615.35, 1, 2e-3);
  EXPECT_NEAR(elastic.duration / 6.10428e-6, 1, 2e-3);
  EXPECT_NEAR(elastic.a.velocity_m_s.z() / 3.9, 1, 1e-4);
  const double table[][3] = {{.98008, .99198, .99156}, {.95051, .97990, .98304}, {.90203, .95959, .97112}, {.80810, .91830, .95017},
                             {.71820, .87599, .93046}, {.63229, .83247, .91083}, {.55028, .78747, .89062}, {.47201, .74060, .86927},
                             {.39714, .69116, .84607}, {.32486, .63779, .81989}, {.25273, .57685, .78803}, {.21370, .53941, .76716}};
  for (const auto& row : table) {
    const Impact hit = hit_plane(kAluminiumOxide, {row[0], .092, 0, 0}, 3.9, 0, 0, 2000);
    EXPECT_NEAR(hit.a.velocity_m_s.z() / 3.9, row[0], 2e-3) << "e = " << row[0];
    EXPECT_NEAR(hit.peak_overlap / 8.08881e-6, row[1], 2e-3) << "e = " << row[0];
    EXPECT_NEAR(hit.push_time / 6.10428e-6, row[2], 2e-3) << "e = " << row[0];
  }
}
/// ... for any size, stiffness and speed: dimensionless law. Soft powder against steel, slow and fast. 2e-3 as above.
TEST(DampedHertz, RestitutionDoesNotDependOnSizeStiffnessOrSpeed) {
  for (const double e : {.8, .5, .25})
    for (const double speed : {1e-3, .1, 5.})
      EXPECT_NEAR(hit_plane({1e7, .25, 1900, 2e-4}, {e, .5, .1, .3}, speed, 0, 0, 1500).a.velocity_m_s.z() / speed, e, 2e-3) << e << " at " << speed;
}

/// A sphere let fall a little settles at the Hertz overlap: R = 1 mm, E = 10 MPa: 3.736687e-7 m. The restoring oscillation dies out completely, so
/// only rounding of the position is left: 1e-6 (printed digits of the reference).
TEST(Rest, StaticOverlapAndFloorForce) {
  const Ball ball{1e7, .25, 2500, 1e-3};
  Simulation sim(scene::setup(1e-6, on_rigid(ball, {.5, .5, .1, .3}), Vec3(0, 0, -9.81)));
  sim.add_wall(rigid_plane());
  sim.add_grain(scene::grain(Vec3(0, 0, 1.0001e-3), 1e-3));
  sim.step(60000);
  EXPECT_NEAR(sim.contacts().at(0).overlap_m / 3.736687e-7, 1, 1e-6);
  EXPECT_NEAR(-sim.wall_load(0).force_n.z() / (ball.mass() * 9.81), 1, 1e-6);
  EXPECT_NEAR(sim.contacts().at(0).normal_force_n / sim.contacts().at(0).overlap_m / 274.9229, 1, 1e-6);
}
/// N spheres: the floor carries the whole weight. A 4 x 4 x 4 loose block; 1e-4.
TEST(Rest, FloorForceIsTheWeightOfAllGrains) {
  SimulationSetup s = scene::setup(4e-6, scene::powder(.3, .5, .1, .3), Vec3(0, 0, -9.81));
  s.box.high = Vec3(3.3e-3, 3.3e-3, 1), s.box.periodic[0] = s.box.periodic[1] = true;
  Simulation sim(s);
  sim.add_wall(scene::plane());
  double weight = 0;
  for (int k = 0; k < 64; ++k) {
    const double r = 3e-4 + 1e-4 * ((k * 7) % 11) / 11.0;
    weight += 9.81 * sim.grain(sim.add_grain(scene::grain(Vec3(k % 4 + .5 + .02 * (k % 3), k / 4 % 4 + .5, k / 16 + .5) * 8.2e-4, r))).mass_kg;
  }
  sim.step(75000);
  EXPECT_NEAR(-sim.wall_load(0).force_n.z() / weight, 1, 1e-4);
}

/// Mean |error of e| over 64 positions of the first touch inside a step.
double mean_error(double e, int steps_per_contact) {
  double sum = 0;
  for (int k = 0; k < 64; ++k)
    sum += std::abs(hit_plane(kAluminiumOxide, {e, 0, 0, 0}, 3.9, 0, 0, steps_per_contact, (k + .5) / 64).a.velocity_m_s.z() / 3.9 - e);
  return sum / 64;
}
/// Order of velocity Verlet on one impact. Published means for e = 1: 1.7e-3, 2.8e-4, 4.7e-5, 8.1e-6, 1.4e-6 (order 2.5): held to a factor 1.5. For
/// e < 1 the published values are of the unclamped law with the textbook damping (1.4e-2 at 10 steps, order 1); the engine's law is clamped and its
/// input is the measured restitution, a different curve of the same order: slope >= 0.9, and at most 3e-2 at 10 steps.
TEST(Order, ErrorOfRestitutionFallsWithTheStep) {
  const double published[] = {1.7e-3, 2.8e-4, 4.7e-5, 8.1e-6, 1.4e-6};
  std::vector<double> elastic, damped;
  for (int k = 0; k < 5; ++k) elastic.push_back(mean_error(1, 10 << k)), damped.push_back(mean_error(.5, 10 << k));
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_GT(elastic[k], published[k] / 1.5) << k;
    EXPECT_LT(elastic[k], published[k] * 1.5) << k;
  }
  EXPECT_GE(std::log2(elastic[0] / elastic[4]) / 4, 2.0);
  EXPECT_LE(std::log2(elastic[0] / elastic[4]) / 4, 3.0);  // steeper would mean that the coarse end is broken
  EXPECT_GE(std::log2(damped[0] / damped[4]) / 4, 0.9);
  EXPECT_LE(std::log2(damped[0] / damped[4]) / 4, 2.0);
  EXPECT_LT(damped[0], 3e-2);
  EXPECT_GT(damped[4], 1e-6);  // there is an error to speak of: the runs are not all alike
}

/// Lowest and highest drift of the energy over `bounces` of an elastic sphere (R = 5 mm, E = 10 MPa) that falls 20 mm on a rigid plane.
struct Drift {
  double low = 0, high = 0;
  void add(double relative) { low = std::min(low, relative), high = std::max(high, relative); }
};
const Ball kBouncer{1e7, .25, 2500, 5e-3};
constexpr double kHeight = .02, kGravity = 9.81, kContactTime = 9.862e-4;

Drift engine_drift(int steps_per_contact, int bounces) {
  const double dt = kContactTime / steps_per_contact, flight = std::sqrt(2 * kHeight / kGravity);
  Simulation sim(scene::setup(dt, on_rigid(kBouncer, {1, 0, 0, 0}), Vec3(0, 0, -kGravity)));
  sim.add_wall(rigid_plane());
  sim.add_grain(scene::grain(Vec3(0, 0, kBouncer.radius + kHeight), kBouncer.radius));
  sim.step(static_cast<std::int64_t>(2 * flight / dt) + steps_per_contact);  // near the top, as after every further bounce
  Drift drift;
  for (int k = 0; k < bounces; ++k) {
    const GrainState s = sim.grain(0);
    if (s.position_m.z() > kBouncer.radius)  // in the air all energy is kinetic + potential
      drift.add((.5 * s.velocity_m_s.squaredNorm() / kGravity + s.position_m.z() - kBouncer.radius) / kHeight - 1);
    sim.step(static_cast<std::int64_t>((2 * flight + kContactTime) / dt));
  }
  return drift;
}
/// The same sphere by a bare velocity-Verlet loop.
Drift loop_drift(int steps_per_contact, int bounces) {
  const double dt = kContactTime / steps_per_contact, k = 4.0 / 3 * kBouncer.plane_modulus() * std::sqrt(kBouncer.radius) / kBouncer.mass();
  double z = kHeight, v = 0, a = -kGravity;  // z: height of the lowest point
  Drift drift;
  for (bool rising = false; bounces > 0;) {
    v += a * dt / 2, z += v * dt;
    a = -kGravity + (z < 0 ? k * std::pow(-z, 1.5) : 0);
    v += a * dt / 2;
    if (rising && v <= 0 && z > 0) drift.add((.5 * v * v / kGravity + z) / kHeight - 1), --bounces;
    rising = v > 0;
  }
  return drift;
}
/// Published ranges for 1000 bounces: 10 steps per contact -4 ... +10 %, 20: -.4 ... +4 %, 50: <= 2e-4, 100: <= 7e-6, with a factor 3 allowed. The 50
/// step bound is kept. The 100 step figure belongs to one sequence of sub-step phases: the bare loop below, an independent integrator of the same
/// scheme, drifts by -2.8e-6 ... +2.55e-5 from this start (and by -1.7e-5 ... +1e-6 from 15 mm), so the engine is held to that loop, to 2e-6
/// (the two round differently, which shifts sub-step phases a little), and to the mean error of one impact at 80 steps (2 x 8.1e-6) per side times 3.
/// The coarse run shows that the measure sees a drift.
TEST(LongBounce, EnergyDriftOfTwoHundredElasticBounces) {
  for (const int steps : {50, 100}) {
    const Drift engine = engine_drift(steps, 200), loop = loop_drift(steps, 200);
    EXPECT_NEAR(engine.low, loop.low, 2e-6) << steps;
    EXPECT_NEAR(engine.high, loop.high, 2e-6) << steps;
    EXPECT_LT(engine.high - engine.low, steps == 50 ? 3 * 2e-4 : 3 * 2 * 8.1e-6) << steps;
  }
  const Drift coarse = engine_drift(10, 100);
  EXPECT_GT(coarse.high - coarse.low, 1e-2);
}
}  // namespace
}  // namespace venato::dem::verification
