/// Moving walls: take-off from a vibrating plate, a grain in a turning cylinder, work of walls.
#include <gtest/gtest.h>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
constexpr double kG = 9.81;

struct Flight {
  double off, on;  ///< phases of the plate [rad]
};
/// One grain, e ~ 0, on a plate z = A sin(w t) with A w^2 = strength g.
Flight fly(double strength, double drive = 1) {
  const Ball ball{1e11, .25, 1900, 2e-4};
  const double hz = 50, w = 2 * std::numbers::pi * hz, amplitude = drive * strength * kG / (w * w), dt = 5e-8;
  Simulation sim(scene::setup(dt, on_rigid(ball, {.02, .5, 0, 0}), Vec3(0, 0, -kG)));
  Wall plate = rigid_plane();
  plate.motion.vibration_amplitude_m = Vec3(0, 0, amplitude);
  plate.motion.vibration_hz = hz;
  sim.add_wall(plate);
  sim.add_grain(scene::grain(Vec3(0, 0, ball.radius - static_overlap(ball, ball.mass() * kG)), ball.radius, Vec3(0, 0, amplitude * w)));
  Flight f{0, 0};
  sim.step(static_cast<std::int64_t>(.1 / w / dt));
  while (sim.time_s() * w < 7 && f.on == 0) {
    sim.step();
    const bool pushed = sim.wall_load(0).force_n.z() < 0;
    if (!pushed && f.off == 0) f.off = sim.time_s() * w;
    if (pushed && f.off > 0 && sim.time_s() * w > f.off + .5) f.on = sim.time_s() * w;
  }
  return f;
}
/// Take-off at asin(1 / strength), landing after a free flight: exact for a hard grain, .2 %. E = 100 GPa: the static overlap is 1e-5 of the
/// amplitude. Negative control: an amplitude 1 % too small.
TEST(VibratingPlate, TakeOffAndLanding) {
  const double table[][3] = {
      {1.2, .985111, 3.387416}, {1.5, .729728, 4.295944}, {2.0, .523599, 5.182450}, {2.5, .411517, 5.798153}, {3.0, .339837, 6.307445}};
  auto as_table = [](const Flight& f, const double(&row)[3]) { return std::abs(f.off / row[1] - 1) <= 2e-3 && std::abs(f.on / row[2] - 1) <= 2e-3; };
  for (const auto& row : table) {
    const Flight f = fly(row[0]);
    EXPECT_TRUE(as_table(f, row)) << row[0] << ": " << f.off << " " << f.on;
  }
  EXPECT_FALSE(as_table(fly(1.5, .99), table[1]));
}

/// A grain in a cylinder that turns about its own axis rests where friction and rolling friction balance: tan(phi) = mu_r (R* = R) on the rising
/// side, the grain rolling with the wall, its centre at rest. From that place and spin it must stay (1 % of mu_r over 4 turns of the cylinder and .4
/// s, about 6 periods of the swing it would make), for any speed; with mu_r = 0 that place is phi = 0. Negative control: the same grain without
/// rolling friction leaves it at once.
double farthest_off(double rate, double mu_r_place, double mu_r) {
  const Ball ball{1e7, .25, 1900, 5e-4};
  const double r_c = .01, phi = std::atan(mu_r_place), m = ball.mass(), dt = 4e-6;
  Simulation sim(scene::setup(dt, on_rigid(ball, {.3, .6, mu_r, .3}), Vec3(0, 0, -kG)));
  Wall drum;
  drum.shape = CylinderShape{Vec3(0, -.01, 0), Vec3::UnitY(), .02, r_c, true};
  drum.material = 1;
  drum.motion.rotation_rad_s = Vec3(0, rate, 0);  // bottom (z = -r_c) moves towards -x
  sim.add_wall(drum);
  const double reach = r_c - ball.radius + static_overlap(ball, m * kG * std::cos(phi));
  const Vec3 start(-reach * std::sin(phi), 0, -reach * std::cos(phi));
  sim.add_grain(scene::grain(start, ball.radius, Vec3::Zero(), Vec3(0, rate * r_c / ball.radius, 0)));
  double worst = 0;
  for (int k = 0; k < 100; ++k) {
    sim.step(1000);
    const Vec3 x = sim.grain(0).position_m;
    worst = std::max(worst, std::abs(-x.x() / -x.z() - std::tan(phi)));
  }
  return worst;
}
TEST(TurningCylinder, OneGrainRestsAtTheRollingFriction) {
  for (const double rate : {20., 63.})
    for (const double mu_r : {0., .05, .1}) EXPECT_LE(farthest_off(rate, mu_r, mu_r), std::max(1e-2 * mu_r, 1e-4)) << rate << " " << mu_r;
  EXPECT_GT(farthest_off(63, .1, 0), .1);
  EXPECT_GT(farthest_off(63, 0, .1), .1);
}

/// Energy that walls put in: the books close and the work is the integral of force times velocity (torque times rotation), taken here from
/// wall_load() and the motion by the trapezoid, independent of the books: 1e-3. The books close to 1.5e-3 of what they turn over, at 500 steps per
/// contact (they are first order in the step: 5e-3 at 100). Twelve grains in a cup on a shaker, and in a cylinder that turns.
struct Work {
  double book, integral, balance, dissipated;
};
Work work_of(bool turning, double dt) {
  const Ball ball{1e7, .25, 1900, 4e-4};
  SimulationSetup s = scene::setup(dt, on_rigid(ball, {.6, .4, .1, .3}), Vec3(0, 0, -kG));
  s.track_energy = true;
  Simulation sim(s);
  Wall cup;
  cup.shape = CylinderShape{Vec3(0, -1.5e-3, 0), Vec3::UnitY(), 3e-3, 2.5e-3, true};
  cup.material = 1;
  const double hz = 80, w = 2 * std::numbers::pi * hz, a = 2.5 * kG / (w * w), rate = 40;
  if (turning)
    cup.motion.rotation_rad_s = Vec3(0, rate, 0);
  else
    cup.motion.vibration_amplitude_m = a * Vec3(.5, 0, .8), cup.motion.vibration_hz = hz;
  sim.add_wall(cup);
  for (const double y : {-1.5e-3, 1.5e-3}) {
    Wall lid = scene::plane(Vec3(0, y, 0), Vec3(0, y < 0 ? 1 : -1, 0));
    lid.material = 1;
    sim.add_wall(lid);
  }
  for (int k = 0; k < 12; ++k)
    sim.add_grain(scene::grain(Vec3((k % 3 - 1) * 9e-4, (k / 6 - .5) * 1e-3, (k / 3 % 2 - .7) * 9e-4), ball.radius * (1 - .05 * (k % 4))));
  const EnergyBook start = sim.energy();
  double integral = 0, power = 0;
  for (int k = 0; k < static_cast<int>(.06 / dt); ++k) {
    sim.step();
    const WallLoad load = sim.wall_load(0);
    const Vec3 v = a * w * std::cos(w * sim.time_s()) * Vec3(.5, 0, .8);
    const double now = turning ? -load.torque_n_m.y() * rate : -load.force_n.dot(v);
    integral += .5 * (power + now) * dt, power = now;
  }
  const EnergyBook end = sim.energy();
  return {end.wall_work_j, integral, end.kinetic_j() + end.potential_j + end.elastic_j() + end.dissipated_j() - start.kinetic_j() - start.potential_j,
          end.dissipated_j()};
}
TEST(WallWork, IsForceTimesVelocityAndClosesTheBooks) {
  for (const bool turning : {false, true}) {
    const Work w = work_of(turning, 2e-7);
    EXPECT_GT(w.integral, 0);
    EXPECT_NEAR(w.book / w.integral, 1, 1e-3) << turning;
    EXPECT_NEAR((w.balance - w.integral) / w.dissipated, 0, 1.5e-3) << turning;
    EXPECT_GT(w.dissipated, .3 * w.integral) << turning;  // an engine that forgets a loss or the work would be off by that
  }
}
}  // namespace
}  // namespace venato::dem::verification
