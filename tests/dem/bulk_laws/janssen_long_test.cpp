// Load on the floor of a tall silo: walls carry most of the weight once their friction is mobilised (Janssen 1895), none of it without friction.
#include <gtest/gtest.h>

#include <numbers>

#include "dem/fields/continuum.h"
#include "tests/dem/bulk_laws/powder_scenes.h"

namespace venato::dem::bulk {
namespace {
constexpr double kRadius = 5 * kD;
constexpr int kGrains = 4000;  // about 50 diameters high

struct Silo {
  double weight_n = 0, floor_n = 0, mobilised = 0, height_m = 0;
  std::vector<double> z_m, sigma_zz_pa, sigma_rr_pa;
};
Silo silo(double wall_friction) {
  MaterialTable materials = powder(.5, .1, wall_friction);
  for (const std::size_t pair : {1u, 2u, 3u}) materials.pairs[pair].rolling_friction = 0;
  SimulationSetup s = setup(materials, Vec3(1, 1, 1), false, false);
  Simulation sim(s);
  Wall floor = plane(Vec3::Zero(), Vec3::UnitZ());
  const double start = 0.5, speed = 0.02, way = 2.5 * kD;
  floor.motion.velocity_m_s = Vec3(0, 0, -speed);
  floor.motion.translate_when = {{start, start + way / speed}};
  const int floor_at = sim.add_wall(floor);
  sim.add_wall(wall(CylinderShape{Vec3(0, 0, -0.1), Vec3::UnitZ(), 2, kRadius, true}));
  pour(sim, kGrains, Vec3(-kRadius, -kRadius, 0), Vec3(kRadius, kRadius, 0), 2,
       [](const Vec3& p) { return std::hypot(p.x(), p.y()) < kRadius - 0.58 * kD; });
  sim.step(std::llround((start + 0.5 * way / speed) / kStep));
  // Means over the second half of the floor's way, when the whole column has come to slide down along the wall.
  Box box;
  box.low = Vec3(-kRadius, -kRadius, -kD), box.high = Vec3(kRadius, kRadius, 0.36);
  ContinuumSums sums(make_continuum_grid(box, Vec3(1, 1, kD), 1.5 * kD));
  Silo r;
  double normal = 0, up = 0;
  const int samples = 50;
  const Vec3 before = sim.wall_impulse_n_s(floor_at);
  const double t0 = sim.time_s();
  for (int k = 0; k < samples; ++k) {
    sim.step(std::llround(0.5 * way / speed / kStep / samples));
    const auto grains = sim.grains();
    const auto contacts = sim.contacts();
    sums.add(grains, contacts);
    for (const ContactState& c : contacts)
      if (c.wall == 1) normal += c.normal_force_n, up += c.tangential_force_n.z();
  }
  r.floor_n = -(sim.wall_impulse_n_s(floor_at) - before).z() / (sim.time_s() - t0);
  r.weight_n = mass(sim) * kGravity;
  r.mobilised = up / normal;
  r.height_m = top(sim);
  const ContinuumFields f = continuum_fields(sums);
  // Averages over the square box of the grid; the stress lives in the cylinder.
  const double area = 4 * kRadius * kRadius / (std::numbers::pi * kRadius * kRadius);
  for (int k = 0; k < f.grid.n[2]; ++k) {
    const std::size_t c = f.grid.index(0, 0, k);
    r.z_m.push_back(f.grid.centre_m(2, k));
    r.sigma_zz_pa.push_back(-area * (f.contact_stress_pa[c][8] + f.kinetic_stress_pa[c][8]));
    r.sigma_rr_pa.push_back(-area * 0.5 * (f.contact_stress_pa[c][0] + f.contact_stress_pa[c][4]));
  }
  return r;
}
double at(const Silo& s, const std::vector<double>& field, double z_m) {
  const double g = (z_m - s.z_m.front()) / (s.z_m[1] - s.z_m[0]);
  const auto k = static_cast<std::size_t>(g);
  return field[k] + (g - static_cast<double>(k)) * (field[k + 1] - field[k]);
}

TEST(Janssen, floor_load_saturates_on_rough_walls) {
  const double mu = 0.3;
  const Silo s = silo(mu);
  ASSERT_GT(s.height_m, 40 * kD);
  RecordProperty("floor_over_weight", std::to_string(s.floor_n / s.weight_n));
  RecordProperty("mobilised", std::to_string(s.mobilised));
  // Grains slide down along the wall: friction near its limit, less the contacts that roll, have just been made, or carry a grain that is pushed back
  // up.
  EXPECT_GT(s.mobilised, 0.7 * mu);
  EXPECT_LE(s.mobilised, mu * (1 + 1e-9));
  const double deep = at(s, s.sigma_zz_pa, 8 * kD), middle = at(s, s.sigma_zz_pa, s.height_m - 30 * kD),
               shallow = at(s, s.sigma_zz_pa, s.height_m - 8 * kD);
  const double k = at(s, s.sigma_rr_pa, 15 * kD) / at(s, s.sigma_zz_pa, 15 * kD);
  RecordProperty("sigma_zz_pa_deep_middle_shallow", std::to_string(deep) + " " + std::to_string(middle) + " " + std::to_string(shallow));
  RecordProperty("K", std::to_string(k));
  EXPECT_GT(k, 0.3);  // a bed at rest has 0.3 … 0.6; one that is dragged along its walls presses harder on them, up to about isotropic
  EXPECT_LT(k, 1.2);
  // l = D / (4 mu K): saturated to 10 % below 2.3 l. Between 30 d below the top and 8 d above the floor a liquid would gain half as much again.
  EXPECT_NEAR(deep / middle, 1, 0.15);
  EXPECT_GT(middle / shallow, 1.15);
  // s_inf = rho_b g D / (4 mu K), with what the walls really mobilise. 20 %: K is the mean over the section here and the wall's in the law.
  const double limit = 0.58 * kDensity * kGravity * 2 * kRadius / (4 * s.mobilised * k);
  RecordProperty("deep_over_limit", std::to_string(deep / limit));
  EXPECT_NEAR(deep / limit, 1, 0.2);
  EXPECT_LT(s.floor_n / s.weight_n, 0.4);
}
TEST(Janssen, frictionless_walls_carry_nothing) {
  const Silo s = silo(0);
  EXPECT_NEAR(s.floor_n / s.weight_n, 1, 0.01);  // the floor sinks at 20 mm/s: the column follows it
  EXPECT_NEAR(at(s, s.sigma_zz_pa, 8 * kD) / at(s, s.sigma_zz_pa, s.height_m - 30 * kD), (s.height_m - 8 * kD) / (30 * kD), 0.1);  // hydrostatic
}
}  // namespace
}  // namespace venato::dem::bulk
