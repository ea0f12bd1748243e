// Tapped density: a loose bed densifies tap by tap towards random close packing, never beyond, and rougher grains gain more (Hausner ratio).
#include <gtest/gtest.h>

#include <numbers>

#include "dem/fields/continuum.h"
#include "tests/dem/bulk_laws/powder_scenes.h"

namespace venato::dem::bulk {
namespace {
constexpr double kSide = 7 * kD;
constexpr int kGrains = 700, kTaps = 40;

/// Solid fraction of the middle of the bed, three diameters off the floor and the surface.
double density(const Simulation& sim) {
  Box box;
  box.low = Vec3(0, 0, -kD), box.high = Vec3(kSide, kSide, 40 * kD);
  box.periodic[0] = box.periodic[1] = true;
  ContinuumSums sums(make_continuum_grid(box, Vec3(1, 1, 0.5 * kD), kD));
  sums.add(sim.grains(), {});
  const ContinuumFields f = continuum_fields(sums);
  double areal = 0, above = 0, mean = 0, n = 0;
  for (const double phi : f.solid_fraction) areal += phi;
  double surface = 0;
  for (int k = f.grid.n[2] - 1; k >= 0 && above < 0.02 * areal; --k)
    above += f.solid_fraction[static_cast<std::size_t>(k)], surface = f.grid.centre_m(2, k);
  for (int k = 0; k < f.grid.n[2]; ++k)
    if (f.grid.centre_m(2, k) > 3 * kD && f.grid.centre_m(2, k) < surface - 3 * kD) mean += f.solid_fraction[static_cast<std::size_t>(k)], n += 1;
  return mean / n;
}

/// Densities after 0, 1, 2, … taps: one swing of 0.25 d at 25 Hz (2.5 g), then rest.
std::vector<double> tapped(double friction, double rolling) {
  SimulationSetup s = setup(powder(friction, rolling, friction), Vec3(kSide, kSide, 1), true, true);
  Simulation sim(s);
  const double settle = 0.4, period = 0.04, pause = 0.12;
  Wall floor = plane(Vec3::Zero(), Vec3::UnitZ());
  floor.motion.vibration_amplitude_m = Vec3(0, 0, 0.25 * kD);
  floor.motion.vibration_hz = 1 / period;
  for (int k = 0; k < kTaps; ++k) {
    const double on = settle + k * (period + pause);
    floor.motion.vibrate_when.push_back({on, on + 0.999 * period});  // ends at the next zero of the swing: its own period
  }
  sim.add_wall(floor);
  pour(sim, kGrains, Vec3::Zero(), Vec3(kSide, kSide, 0), 6);
  sim.step(std::llround(settle / kStep));
  std::vector<double> phi{density(sim)};
  for (int k = 0; k < kTaps; ++k) {
    sim.step(std::llround((period + pause) / kStep));
    EXPECT_LT(mean_speed(sim), 0.01) << "tap " << k;  // at rest again, but for single rattlers; the floor swings at 0.16 m/s
    phi.push_back(density(sim));
  }
  return phi;
}
double mean(const std::vector<double>& v, std::size_t from, std::size_t to) {
  double s = 0;
  for (std::size_t k = from; k < to; ++k) s += v[k] / static_cast<double>(to - from);
  return s;
}

TEST(Tapping, densifies_without_a_dip_and_rougher_grains_gain_more) {
  const std::vector<double> rough = tapped(.5, .2), smooth = tapped(.1, 0);
  for (const auto* v : {&rough, &smooth}) {
    std::string line;
    for (const std::size_t k : {0u, 1u, 2u, 5u, 10u, 20u, 30u, 40u}) line += std::to_string((*v)[k]) + " ";
    RecordProperty(v == &rough ? "rough" : "smooth", line);
    // Means over taps: single ones rearrange by +-0.002. No dip: each stretch is denser than the one before.
    const double stretch[] = {(*v)[0], mean(*v, 1, 6), mean(*v, 6, 16), mean(*v, 16, 26), mean(*v, 26, 41)};
    for (int k = 1; k < 5; ++k) EXPECT_GT(stretch[k], stretch[k - 1] - 0.001) << k;
    EXPECT_GT(stretch[4], stretch[0] + 0.005);
    for (const double phi : *v) EXPECT_LT(phi, 0.65);  // random close packing of nearly equal spheres is 0.64
    EXPECT_GT((*v)[0], 0.5);
  }
  EXPECT_LT(rough.front(), smooth.front() - 0.01);                                  // pours looser
  EXPECT_GT(rough.back() / rough.front(), 1.01);                                    // Hausner ratio above 1
  EXPECT_GT(rough.back() / rough.front(), smooth.back() / smooth.front() + 0.005);  // and it grows with friction
}
}  // namespace
}  // namespace venato::dem::bulk
