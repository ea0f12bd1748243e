/// A drum in steady rotation: torque on the shell times rotation is the power that the grains dissipate.
#include <gtest/gtest.h>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
/// A hundred grains (R = .5 mm) tumble in a smooth cylinder (R = 5 mm, 3 mm long, periodic along its axis) with friction and rolling friction. Over
/// four turns after two to settle: work of the shell (own trapezoid over wall_load) = dissipated energy, 1 %; what moves to and fro between kinetic
/// and potential is far less than that; the mean torque is that of the bed's weight at its mean offset, i.e. the moment of gravity about the axis, 1
/// %.
TEST(Drum, TorqueTimesRotationIsTheDissipatedPower) {
  const Ball ball{5e6, .25, 1900, 5e-4};
  const double g = 9.81, rate = 25, dt = 8e-6, r_c = 5e-3;
  SimulationSetup s = scene::setup(dt, on_rigid(ball, {.5, .5, .1, .3}), Vec3(0, 0, -g));
  s.track_energy = true, s.box.high = Vec3(1, 3e-3, 1), s.box.low = Vec3(-1, 0, -1), s.box.periodic[1] = true;
  Simulation sim(s);
  Wall drum;
  drum.shape = CylinderShape{Vec3(0, -1, 0), Vec3::UnitY(), 2, r_c, true};
  drum.material = 1, drum.motion.rotation_rad_s = Vec3(0, rate, 0);
  sim.add_wall(drum);
  int count = 0;
  for (int z = 0; z < 8 && count < 100; ++z)
    for (int x = 0; x < 8 && count < 100; ++x)
      for (int y = 0; y < 3 && count < 100; ++y) {
        const Vec3 at((x - 3.5) * 1.05e-3, (y + .3 + .2 * (z % 2)) * 1e-3, (z - 3.5) * 1.05e-3);
        if (Vec3(at.x(), 0, at.z()).norm() < r_c - 5.2e-4) sim.add_grain(scene::grain(at, ball.radius * (1 - .02 * (count % 6)))), ++count;
      }
  ASSERT_EQ(count, 100);
  const double turn = 2 * std::numbers::pi / rate;
  sim.step(static_cast<std::int64_t>(2 * turn / dt));
  const EnergyBook start = sim.energy();
  double work = 0, torque = sim.wall_load(0).torque_n_m.y(), moment = 0;
  const auto steps = static_cast<std::int64_t>(4 * turn / dt);
  for (std::int64_t k = 0; k < steps; ++k) {
    sim.step();
    const double now = sim.wall_load(0).torque_n_m.y();
    work -= .5 * (torque + now) * rate * dt, torque = now;
    if (k % 20 == 0)
      for (const GrainState& a : sim.grains()) moment += (a.position_m.cross(a.mass_kg * Vec3(0, 0, -g))).y() * 20 / static_cast<double>(steps);
  }
  const EnergyBook end = sim.energy();
  const double dissipated = end.dissipated_j() - start.dissipated_j();
  const double stored = end.kinetic_j() + end.potential_j + end.elastic_j() - start.kinetic_j() - start.potential_j - start.elastic_j();
  std::printf("%d grains: work %.4e J, dissipated %.4e J, stored %.1e J, book %.4e J, torque by gravity %.4e W\n", count, work, dissipated, stored,
              end.wall_work_j - start.wall_work_j, -moment * rate * 4 * turn);
  EXPECT_GT(work, 0);
  EXPECT_NEAR((dissipated + stored) / work, 1, 1e-2);
  EXPECT_NEAR(stored / work, 0, 1e-2);
  EXPECT_NEAR((end.wall_work_j - start.wall_work_j) / work, 1, 1e-3);
  EXPECT_NEAR(-moment * rate * 4 * turn / work, 1, 1e-2);
}
}  // namespace
}  // namespace venato::dem::verification
