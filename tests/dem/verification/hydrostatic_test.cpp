/// Janssen's column: without wall friction the pressure is hydrostatic and the floor carries the weight, with friction the wall takes part of it.
#include <gtest/gtest.h>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
const Ball kBead{1e6, .25, 2000, 1e-3};
constexpr double kG = 9.81, kTube = 5e-3;

struct Column {
  double floor, wall;             ///< vertical load over the weight, mean over 40 ms
  std::vector<double> imbalance;  ///< (force through a level - weight above it) / whole weight, at nine levels
  double momentum_gain = 0;       ///< over weight times time
};
/// 300 beads (+-10 %) settle in a tube of five diameters, about 20 diameters high; then the tube moves up by 2 mm.
Column settle(double mu_wall) {
  PairProperties beads{.3, .3, 0, 0}, wall{.3, mu_wall, 0, 0};
  SimulationSetup s = scene::setup(2e-5, {{kBead.material(), {"rigid", 1, 1e30, .3}}, {beads, wall, wall, wall}}, Vec3(0, 0, -kG));
  Simulation sim(s);
  sim.add_wall(rigid_plane());
  Wall tube;
  tube.shape = CylinderShape{Vec3(0, 0, -.05), Vec3::UnitZ(), .5, kTube, true};
  tube.material = 1;
  sim.add_wall(tube);
  double weight = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 at(2.3e-3 * (k % 3 - 1) + 2e-5 * (k % 7), 2.3e-3 * (k / 3 % 3 - 1) - 2e-5 * (k % 5), 1.2e-3 + 2.3e-3 * (k / 9));
    weight += kG * sim.grain(sim.add_grain(scene::grain(at, kBead.radius * (.9 + .2 * (k * 37 % 100) / 100)))).mass_kg;
  }
  sim.step(30000);  // .6 s: still
  WallMotion lift;
  lift.velocity_m_s = Vec3(0, 0, .02), lift.translate_when = {{sim.time_s(), 10}};
  sim.set_wall_motion(1, lift);  // friction must be mobilised by moving the tube: a heap that rebounded on settling may even hang the other way
  sim.step(4000);
  auto momentum = [&sim] {
    double p = 0;
    for (const GrainState& g : sim.grains()) p += g.mass_kg * g.velocity_m_s.z();
    return p;
  };
  const double momentum_before = momentum();
  const double floor = sim.wall_impulse_n_s(0).z(), wall_before = sim.wall_impulse_n_s(1).z(), steps = 2000,
               unit = -weight * steps * sim.time_step_s();
  sim.step(2000);
  Column c{
      (sim.wall_impulse_n_s(0).z() - floor) / unit, (sim.wall_impulse_n_s(1).z() - wall_before) / unit, {}, (momentum() - momentum_before) / -unit};
  double top = 0;
  for (const GrainState& g : sim.grains()) top = std::max(top, g.position_m.z());
  for (int level = 1; level < 10; ++level) {
    const double z = .1 * level * top;
    double above = 0, through = 0;
    for (const GrainState& g : sim.grains()) above += g.position_m.z() > z ? kG * g.mass_kg : 0;
    for (const ContactState& k : sim.contacts()) {
      if (k.j < 0) continue;
      const bool i_up = sim.grain(k.i).position_m.z() > z, j_up = sim.grain(k.j).position_m.z() > z;
      if (i_up != j_up) through += (i_up ? 1 : -1) * k.force_n.z();
    }
    c.imbalance.push_back((through - above) / weight);
  }
  return c;
}
/// mu_w = 0: floor load = weight, 1 % asked, 1e-3 held (what is left of the motion); nothing vertical on the tube, whose normals are horizontal:
/// rounding; through every level goes the weight above it: 1e-2 of the weight. Control: mu_w = .5 fails the same three checks (the tube bears more
/// than a tenth).
TEST(Column, HydrostaticWithoutWallFriction) {
  auto floor_ok = [](const Column& c) { return std::abs(c.floor - 1) <= 1e-3; };
  auto wall_ok = [](const Column& c) { return std::abs(c.wall) <= 1e-12; };
  auto levels_ok = [](const Column& c) { return std::all_of(c.imbalance.begin(), c.imbalance.end(), [](double x) { return std::abs(x) <= 1e-2; }); };
  const Column smooth = settle(0), rough = settle(.5);
  EXPECT_TRUE(floor_ok(smooth)) << smooth.floor;
  EXPECT_TRUE(wall_ok(smooth)) << smooth.wall;
  EXPECT_TRUE(levels_ok(smooth));
  EXPECT_FALSE(floor_ok(rough));
  EXPECT_FALSE(wall_ok(rough));
  EXPECT_FALSE(levels_ok(rough));
  EXPECT_GT(rough.wall, .1);
  // It moves: floor and tube bear the weight and what changes its momentum. The impulse adds up whole forces, Verlet halves of the first and the
  // last: 1 / 2000 of a change of force of the order of the weight.
  EXPECT_NEAR(rough.floor + rough.wall, 1 + rough.momentum_gain, 1e-3);
  EXPECT_NEAR(smooth.floor + smooth.wall, 1 + smooth.momentum_gain, 1e-3);
}
}  // namespace
}  // namespace venato::dem::verification
