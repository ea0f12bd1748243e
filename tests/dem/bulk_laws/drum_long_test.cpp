// A half-filled rotating drum: what the wall puts in is dissipated, and rolling friction steepens the surface.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/dem/bulk_laws/powder_scenes.h"

namespace venato::dem::bulk {
namespace {
constexpr double kRadius = 12 * kD, kLength = 4 * kD;

struct Drum {
  double torque_work_j = 0, booked_wall_work_j = 0, dissipated_j = 0, stored_j = 0;  ///< of the measured part
  double angle_deg = 0, angle_change_deg = 0;  ///< of the centre of mass about the axis, from straight down; change between halves
};
Drum drum(double rolling_friction) {
  SimulationSetup s = setup(powder(.5, rolling_friction, .5), Vec3(1, kLength, 1), false, true);
  s.track_energy = true;
  Simulation sim(s);
  Wall shell = wall(CylinderShape{Vec3(0, -1, 0), Vec3::UnitY(), 3, kRadius, true});
  const double omega = std::sqrt(0.01 * kGravity / kRadius);  // Froude number 0.01: a continuous, nearly flat surface
  shell.motion.rotation_rad_s = Vec3(0, omega, 0);
  const int at = sim.add_wall(shell);
  pour(sim, 950, Vec3(-kRadius, 0, -kRadius), Vec3(kRadius, kLength, 0), 5,
       [](const Vec3& p) { return std::hypot(p.x(), p.z()) < kRadius - 0.6 * kD; });
  const double period = 2 * std::numbers::pi / omega;
  sim.step(std::llround(0.6 * period / kStep));
  Drum d;
  double half[2] = {0, 0};
  const auto store = [&](const EnergyBook& e) { return e.kinetic_j() + e.potential_j + e.elastic_j(); };
  const EnergyBook start = sim.energy();
  const std::int64_t steps = std::llround(0.8 * period / kStep);
  double torque = sim.wall_load(at).torque_n_m.y();
  for (std::int64_t k = 0; k < steps; ++k) {
    sim.step();
    const double now = sim.wall_load(at).torque_n_m.y();  // by the grains on the wall
    d.torque_work_j -= 0.5 * (torque + now) * omega * kStep;
    torque = now;
    if (k % 200 != 0) continue;
    double x = 0, z = 0, m = 0;
    for (const GrainState& g : sim.grains()) x += g.mass_kg * g.position_m.x(), z += g.mass_kg * g.position_m.z(), m += g.mass_kg;
    half[2 * k / steps] += std::atan2(std::abs(x), -z) * 180 / std::numbers::pi / (static_cast<double>(steps) / 400);
  }
  const EnergyBook end = sim.energy();
  d.booked_wall_work_j = end.wall_work_j - start.wall_work_j;
  d.dissipated_j = end.dissipated_j() - start.dissipated_j();
  d.stored_j = store(end) - store(start);
  d.angle_deg = 0.5 * (half[0] + half[1]), d.angle_change_deg = std::abs(half[0] - half[1]);
  return d;
}

TEST(Drum, torque_times_speed_is_what_is_dissipated_and_rolling_friction_steepens_it) {
  const Drum smooth = drum(0), rough = drum(.2);
  for (const Drum* d : {&smooth, &rough}) {
    char line[200];
    std::snprintf(line, sizeof line, "wall %.5f J (booked %.5f), dissipated %.5f, stored %.5f; angle %.2f deg (change %.2f)", d->torque_work_j,
                  d->booked_wall_work_j, d->dissipated_j, d->stored_j, d->angle_deg, d->angle_change_deg);
    RecordProperty(d == &smooth ? "mu_r_0" : "mu_r_0.2", line);
    // verification.md 6.9: 1 %. The torque is summed outside of the engine's energy book.
    EXPECT_NEAR((d->dissipated_j + d->stored_j) / d->torque_work_j, 1, 0.01);
    EXPECT_NEAR(d->booked_wall_work_j / d->torque_work_j, 1, 0.01);
    EXPECT_LT(d->stored_j / d->torque_work_j, 0.1);  // steady: nearly all of it is dissipated
    EXPECT_LT(d->angle_change_deg, 2);
  }
  // Dynamic angles of repose of spheres with mu = 0.5: 20 … 30 deg without rolling friction; several degrees more with mu_r = 0.2.
  EXPECT_GT(smooth.angle_deg, 18);
  EXPECT_LT(smooth.angle_deg, 32);
  EXPECT_GT(rough.angle_deg, smooth.angle_deg + 3);
  EXPECT_LT(rough.angle_deg, 50);
}
}  // namespace
}  // namespace venato::dem::bulk
