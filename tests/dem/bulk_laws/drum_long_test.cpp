// A half-filled rotating drum in continuous flow: the dynamic angle of repose is steady, in the range of spheres, and rises with rolling friction.
// (That torque times speed is what is dissipated stands in verification/drum_power_long_test.cpp.)
#include <gtest/gtest.h>

#include <numbers>

#include "tests/dem/bulk_laws/powder_scenes.h"

namespace venato::dem::bulk {
namespace {
constexpr double kRadius = 12 * kD, kLength = 4 * kD;

struct Drum {
  double angle_deg = 0, change_deg = 0;  ///< of the centre of mass about the axis, from straight down; change between the halves of the window
  double torque_over_weight = 0;         ///< mean torque on the shell over weight times offset of the centre of mass
};
Drum drum(double rolling_friction) {
  Simulation sim(setup(powder(.5, rolling_friction, .5), Vec3(1, kLength, 1), false, true));
  Wall shell = wall(CylinderShape{Vec3(0, -1, 0), Vec3::UnitY(), 3, kRadius, true});
  const double omega = std::sqrt(0.01 * kGravity / kRadius);  // Froude number 0.01: a continuous, nearly flat surface
  shell.motion.rotation_rad_s = Vec3(0, omega, 0);
  const int at = sim.add_wall(shell);
  pour(sim, 950, Vec3(-kRadius, 0, -kRadius), Vec3(kRadius, kLength, 0), 5,
       [](const Vec3& p) { return std::hypot(p.x(), p.z()) < kRadius - 0.6 * kD; });
  const double period = 2 * std::numbers::pi / omega;
  sim.step(std::llround(0.5 * period / kStep));
  Drum d;
  double half[2] = {0, 0}, torque = 0, moment = 0;
  constexpr int samples = 400;  // 200 for each half
  const std::int64_t steps = std::llround(0.5 * period / kStep / samples);
  for (int k = 0; k < samples; ++k) {
    for (std::int64_t q = 0; q < steps; ++q) sim.step(), torque += sim.wall_load(at).torque_n_m.y() / static_cast<double>(steps);
    double x = 0, z = 0, m = 0;
    for (const GrainState& g : sim.grains()) x += g.mass_kg * g.position_m.x(), z += g.mass_kg * g.position_m.z(), m += g.mass_kg;
    moment += kGravity * x;
    half[2 * k / samples] += std::atan2(std::abs(x), -z) * 180 / std::numbers::pi / (samples / 2);
  }
  return {0.5 * (half[0] + half[1]), std::abs(half[0] - half[1]), torque / moment};
}

TEST(Drum, rolling_friction_steepens_a_steady_surface) {
  const Drum smooth = drum(0), rough = drum(.2);
  for (const Drum* d : {&smooth, &rough}) {
    RecordProperty(d == &smooth ? "mu_r_0" : "mu_r_0.2", std::to_string(d->angle_deg) + " deg, change " + std::to_string(d->change_deg) +
                                                             ", torque / moment " + std::to_string(d->torque_over_weight));
    EXPECT_LT(d->change_deg, 2);                            // steady
    EXPECT_NEAR(std::abs(d->torque_over_weight), 1, 0.03);  // the shell holds the bed's weight at its offset; what the bed still swings is the rest
  }
  // Dynamic angles of repose of spheres with mu = 0.5: 20 … 35 deg without rolling friction; several degrees more with mu_r = 0.2.
  EXPECT_GT(smooth.angle_deg, 18);
  EXPECT_LT(smooth.angle_deg, 35);
  EXPECT_GT(rough.angle_deg, smooth.angle_deg + 3);
  EXPECT_LT(rough.angle_deg, 50);
}
}  // namespace
}  // namespace venato::dem::bulk
