/// Janssen's column: without wall friction the pressure is hydrostatic and the floor carries the weight, with friction the wall takes part of it.
#include <gtest/gtest.h>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
const Ball kBead{1e6, .25, 2000, 1e-3};
constexpr double kG = 9.81, kTube = 5e-3;

struct Column {
  double floor, wall;             ///< vertical load over the weight
  std::vector<double> imbalance;  ///< (force through a level - weight above it) / whole weight, at nine levels
};
/// 300 beads (+-10 %) settle in a tube of five diameters, about 20 diameters high.
Column settle(double mu_wall) {
  PairProperties beads{.2, .3, 0, 0}, wall{.2, mu_wall, 0, 0};
  SimulationSetup s = scene::setup(4e-5, {{kBead.material(), {"rigid", 1, 1e30, .3}}, {beads, wall, wall, wall}}, Vec3(0, 0, -kG));
  Simulation sim(s);
  sim.add_wall(rigid_plane());
  Wall tube;
  tube.shape = CylinderShape{Vec3(0, 0, -.01), Vec3::UnitZ(), .5, kTube, true};
  tube.material = 1;
  sim.add_wall(tube);
  double weight = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 at(2.3e-3 * (k % 3 - 1) + 2e-5 * (k % 7), 2.3e-3 * (k / 3 % 3 - 1) - 2e-5 * (k % 5), 1.2e-3 + 2.3e-3 * (k / 9));
    weight += kG * sim.grain(sim.add_grain(scene::grain(at, kBead.radius * (.9 + .2 * (k * 37 % 100) / 100)))).mass_kg;
  }
  for(int q=0;q<10;++q){sim.step(5000);{static double last=0; Vec3 P=Vec3::Zero(), F=Vec3::Zero(); double low=1; for(auto&g:sim.grains()){P+=g.mass_kg*g.velocity_m_s; F+=g.force_n; low=std::min(low,g.position_m.z());} double I=-sim.wall_impulse_n_s(0).z(); std::printf("impulse mean %.6f P %g sumF %g low %g n %zu ",(I-last)/.2/weight,P.z(),F.z()/weight,low,sim.grain_count()); last=I;} std::printf("%g: floor %.6f wall %.6f ke %g\n",sim.time_s(),-sim.wall_load(0).force_n.z()/weight,-sim.wall_load(1).force_n.z()/weight,sim.energy().kinetic_j());}
  sim.step(25000);  // 1 s: still
  Column c{-sim.wall_load(0).force_n.z() / weight, -sim.wall_load(1).force_n.z() / weight, {}};
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
/// mu_w = 0: floor load = weight, 1 % asked, 1e-3 held (rest of the motion); nothing vertical on the tube, whose normals are horizontal: rounding; through
/// every level goes the weight above it: 1e-2 of the weight. Control: mu_w = .5 fails the same three checks (the tube bears more than a tenth).
TEST(Column, HydrostaticWithoutWallFriction) {
  auto floor_ok = [](const Column& c) { return std::abs(c.floor - 1) <= 1e-3; };
  auto wall_ok = [](const Column& c) { return std::abs(c.wall) <= 1e-12; };
  auto levels_ok = [](const Column& c) {
    return std::all_of(c.imbalance.begin(), c.imbalance.end(), [](double x) { return std::abs(x) <= 1e-2; });
  };
  const Column smooth = settle(0), rough = settle(.5);
  EXPECT_TRUE(floor_ok(smooth)) << smooth.floor;
  EXPECT_TRUE(wall_ok(smooth)) << smooth.wall;
  EXPECT_TRUE(levels_ok(smooth));
  EXPECT_FALSE(floor_ok(rough));
  EXPECT_FALSE(wall_ok(rough));
  EXPECT_FALSE(levels_ok(rough));
  EXPECT_GT(rough.wall, .1);
  EXPECT_NEAR(rough.floor + rough.wall, 1, 1e-3);
}
}  // namespace
}  // namespace venato::dem::verification
