// PR7 of multiscale.md 3.4 and the closed forms of 3.3.
#include "line/press_map/press_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"
#include "line/press_map/displacement.h"
#include "line/press_map/press_gap.h"

using namespace venato;
using namespace venato::line;
using std::numbers::pi;

namespace {
constexpr BedGrid kGrid{80, 120, 2, 2e-3, 0};
constexpr double kMass = 25;

PressMapConfig config() {
  PressMapConfig c;
  c.peak_pressure_pa = 40e6;
  c.density_a_kg_m3 = 1442;
  c.density_b_kg_m3 = 136;
  c.lateral_length_factor = 0.8;
  c.springback = 0.005;
  return c;
}
std::vector<double> uniform() { return std::vector<double>(kGrid.columns(), kMass); }
// m (1 + amplitude cos(2 pi y / L)) with `waves` along the belt.
std::vector<double> wavy(double amplitude, int waves) {
  std::vector<double> m = uniform();
  for (std::size_t i = 0; i < m.size(); ++i) m[i] *= 1 + amplitude * std::cos(2 * pi * waves * (static_cast<double>(i / 80) + 0.5) / 120);
  return m;
}
std::vector<double> rough() {
  std::vector<double> m = uniform();
  Rng rng(1, stream_id("tests/line/press_map"));
  for (double& x : m) x *= 1 + 0.1 * (rng.uniform() - 0.5);
  return m;
}
}  // namespace

TEST(DensityLaw, IsMonotoneAndInverts) {
  double before = 0;
  for (double p = 1e6; p < 60e6; p *= 1.1) {
    const double rho = pressed_density(p, 1442, 136);
    EXPECT_GT(rho, before);
    EXPECT_NEAR(pressure_of_density(rho, 1442, 136) / p, 1, 1e-13);
    before = rho;
  }
  EXPECT_NEAR(pressed_density(25e6, 1442, 136), 1880, 1);  // the reference's own values, rounded to 0.01 g/cm3
  EXPECT_NEAR(pressed_density(45e6, 1442, 136), 1960, 1);
}

TEST(PressMap, UniformMassGivesUniformPressureAndNoDisplacement) {
  const PressMap map = compute_press_map(uniform(), kGrid, config());
  const double rho = 1442 + 136 * std::log(40.0);
  EXPECT_NEAR(map.gap_m / (kMass / rho), 1, 1e-12);
  for (std::size_t i = 0; i < kGrid.columns(); ++i) {
    ASSERT_NEAR(map.pressure_pa[i] / 40e6, 1, 1e-11);
    ASSERT_NEAR(map.density_kg_m3[i] / rho, 1, 1e-12);
    ASSERT_NEAR(map.lateral_x_m[i], 0, 1e-15);
    ASSERT_NEAR(map.lateral_y_m[i], 0, 1e-15);
  }
  EXPECT_EQ(map.share_below_1_mpa, 0);
}

// PR7: mass of each column within 1e-6 (rounding here), also with rough beds and edge gain; mean pressure over the pressed area as set.
TEST(PressMap, KeepsTheMassOfEveryColumn) {
  PressMapConfig c = config();
  c.edge_gain_m = 2e-3;
  c.edge_zone_m = 30e-3;
  const auto mass = rough();
  const PressMap map = compute_press_map(mass, kGrid, c);
  double force = 0, area = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    ASSERT_NEAR(map.thickness_m[i] * map.density_kg_m3[i] * map.area_ratio[i] / mass[i], 1, 1e-13);
    force += map.pressure_pa[i] * map.area_ratio[i];
    area += map.area_ratio[i];
  }
  EXPECT_NEAR(force / area / 40e6, 1, 1e-9);
  EXPECT_NEAR(area * kGrid.pitch_m * kGrid.pitch_m / ((0.16 + 2 * 2e-3) * 0.24), 1,
              1e-3);  // the strip got 4 mm wider: to first order in the mass differences
}

// multiscale.md 3.3: dP / P = rho / b dm / m; 2 % of mass -> + 33 % of pressure (exp(0.02 * 1944 / 136) = 1.331 at 40 MPa).
TEST(PressMap, TwoPercentOfMassIsAThirdOfPressure) {
  PressMapConfig c = config();
  c.lateral_length_factor = 0;  // nothing evens out
  std::vector<double> mass = uniform();
  mass[60 * 80 + 40] *= 1.02;
  const PressMap map = compute_press_map(mass, kGrid, c);
  EXPECT_NEAR(map.pressure_pa[60 * 80 + 40] / map.pressure_pa[0], std::exp(0.02 * (1442 + 136 * std::log(40.0)) / 136), 1e-3);
  EXPECT_NEAR(map.pressure_pa[60 * 80 + 40] / map.pressure_pa[0], 1.33, 0.01);
}

// A wave of wavelength 120 mm >> l_p = 10 mm: u = -l_p^2 grad(dm / m), reduced by 1 / (1 + (k l_p)^2) = 0.78; and the pressure wave with it.
// Tolerance: second differences of the grid, (k h)^2 / 6 = 0.2 %.
TEST(PressMap, LateralFlowOfAWave) {
  const PressMap map = compute_press_map(wavy(0.01, 2), kGrid, config());
  const double k = 2 * pi * 2 / 0.24, l = map.lateral_length_m, damped = 0.01 / (1 + k * k * l * l);
  EXPECT_NEAR(l / (0.8 * map.gap_m), 1, 1e-10);  // as far as gap and length are settled
  double largest = 0, wave = 0;
  for (int j = 0; j < 120; ++j) {
    const auto i = static_cast<std::size_t>(j * 80 + 17);
    largest = std::max(largest, std::abs(map.lateral_y_m[i]));
    EXPECT_NEAR(map.lateral_y_m[i], l * l * damped * k * std::sin(k * (j + 0.5) * 2e-3), 0.005 * l * l * damped * k);
    EXPECT_NEAR(map.lateral_x_m[i], 0, 1e-12);
    wave = std::max(wave, map.density_kg_m3[i] / (kMass / map.gap_m) - 1);
  }
  EXPECT_GT(largest, 0);
  EXPECT_NEAR(wave / damped, 1, 0.02);  // mean (1 + s) to first order: second order is 1 %
}

TEST(PressMap, NothingFlowsThroughTheSideWalls) {
  std::vector<double> mass = uniform();
  for (std::size_t i = 0; i < mass.size(); ++i) mass[i] *= 1 + 0.05 * (static_cast<double>(i % 80) / 80 - 0.5);  // heavier to the right: flows left
  const PressMap map = compute_press_map(mass, kGrid, config());
  EXPECT_NEAR(displacement_at(map, {0, 0.1}).x_m, 0, 1e-18);
  EXPECT_NEAR(displacement_at(map, {0.16, 0.1}).x_m, 0, 1e-18);
  EXPECT_LT(displacement_at(map, {0.08, 0.1}).x_m, -1e-5);
}

TEST(PressMap, SpringbackIsExactAndEdgesMoveOut) {
  const PressMap plain = compute_press_map(uniform(), kGrid, config());
  for (const PlanePoint p : {PlanePoint{0.01, 0.02}, PlanePoint{0.16, 0.24}}) {
    EXPECT_NEAR(pressed_from_belt(plain, p).x_m, 1.005 * p.x_m, 1e-15);
    EXPECT_NEAR(pressed_from_belt(plain, p).y_m, 1.005 * p.y_m, 1e-15);
  }
  PressMapConfig c = config();
  c.edge_gain_m = 1e-3;
  c.edge_zone_m = 40e-3;
  const PressMap map = compute_press_map(uniform(), kGrid, c);
  EXPECT_NEAR(pressed_from_belt(map, {0, 0.1}).x_m, 1.005 * -1e-3, 1e-15);
  EXPECT_NEAR(pressed_from_belt(map, {0.16, 0.1}).x_m, 1.005 * 0.161, 1e-15);
  EXPECT_NEAR(pressed_from_belt(map, {0.02, 0.1}).x_m, 1.005 * (0.02 - 0.25e-3), 1e-15);
  EXPECT_NEAR(pressed_from_belt(map, {0.08, 0.1}).x_m, 1.005 * 0.08, 1e-15);
  EXPECT_LT(map.density_kg_m3[0], map.density_kg_m3[40]);  // wider is thinner on powder
}

// Both ways over a rough bed, to the 1e-9 m that is promised.
TEST(PressMap, InverseOfTheDisplacement) {
  PressMapConfig c = config();
  c.edge_gain_m = 1e-3;
  c.edge_zone_m = 20e-3;
  const PressMap map = compute_press_map(rough(), kGrid, c);
  double moved = 0;
  Rng rng(2, stream_id("tests/line/press_map"));
  for (int k = 0; k < 500; ++k) {
    const PlanePoint belt{0.16 * rng.uniform(), 0.24 * rng.uniform()}, pressed = pressed_from_belt(map, belt), back = belt_from_pressed(map, pressed);
    EXPECT_NEAR(back.x_m, belt.x_m, 1e-9);
    EXPECT_NEAR(back.y_m, belt.y_m, 1e-9);
    moved = std::max(moved, std::abs(pressed.y_m / 1.005 - belt.y_m));
  }
  EXPECT_GT(moved, 1e-5);
}

TEST(PressMap, SameBytesForAnyNumberOfThreads) {
  const PressMap one = compute_press_map(rough(), kGrid, config(), 1), three = compute_press_map(rough(), kGrid, config(), 3);
  EXPECT_EQ(one.pressure_pa, three.pressure_pa);
  EXPECT_EQ(one.lateral_x_m, three.lateral_x_m);
  EXPECT_EQ(one.lateral_y_m, three.lateral_y_m);
}

TEST(PressMap, RefusesWhatHasNoMeaning) {
  EXPECT_THROW(compute_press_map(uniform(), kGrid, PressMapConfig{}), UsageError);  // all forgotten
  PressMapConfig c = config();
  c.density_b_kg_m3 = 0;
  EXPECT_THROW(compute_press_map(uniform(), kGrid, c), UsageError);
  c = config();
  c.edge_gain_m = 0.01;
  c.edge_zone_m = 0.02;
  EXPECT_THROW(compute_press_map(uniform(), kGrid, c), UsageError);
  std::vector<double> hole = uniform();
  hole[5] = 0;
  EXPECT_THROW(compute_press_map(hole, kGrid, config()), WorkError);
}
