#include <gtest/gtest.h>

#include <functional>

#include "dem/rigs/tapped_density/rig.h"
#include "tests/dem/rigs/synthetic.h"

namespace venato::dem::rigs::tapped_density {
namespace {
using synthetic::kpi;
constexpr double kGrain = 5e-4, kRadius = 0.01, kMassDensity = 2000;

Config cylinder(int taps) {
  Config c;
  c.centre_x_m = 0.003, c.centre_y_m = -0.001, c.radius_m = kRadius, c.floor_z_m = 0.002;
  c.taps = taps;
  return c;
}
/// n points evenly at random below height(share of the radius squared).
Snapshot column(int n, std::uint64_t seed, const std::function<double(double)>& height) {
  Rng rng(seed, 2);
  Snapshot s;
  double tallest = 0;
  for (int k = 0; k <= 100; ++k) tallest = std::max(tallest, height(0.01 * k));
  for (int k = 0; k < n;) {
    const double share = rng.uniform(), z = tallest * rng.uniform(), angle = 2 * std::numbers::pi * rng.uniform();
    if (z > height(share)) continue;
    const double r = kRadius * std::sqrt(share);
    s.id.push_back(k++);
    s.position_m.emplace_back(0.003 + r * std::cos(angle), -0.001 + r * std::sin(angle), 0.002 + z);
    s.radius_m.push_back(static_cast<float>(0.5 * kGrain));
    s.species.push_back(0);
  }
  return s;
}
double mass_of(int n) { return n * kMassDensity * std::numbers::pi / 6 * std::pow(kGrain, 3); }
double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x / static_cast<double>(v.size());
  return sum;
}

TEST(TappedDensity, a_column_has_its_bulk_density) {
  const Case c = synthetic::mono_case(kGrain);
  constexpr int kN = 60000;
  const double area = std::numbers::pi * kRadius * kRadius;
  // Mean heights of 18 columns of 3333 points: each to 0.58 / sqrt(3333) = 1 %, all together 0.24 %.
  const auto flat = wedge_densities(column(kN, 1, [](double) { return 0.02; }), c, cylinder(1));
  ASSERT_EQ(flat.size(), 6u);
  EXPECT_NEAR(mean(flat) / (mass_of(kN) / (area * 0.02)), 1, 0.01);
  for (const double d : flat) EXPECT_NEAR(d / mean(flat), 1, 0.06);  // number of points in a wedge: 1 %; its heights 0.6 %
  // A heaped surface: volume = integral of the height. Linear in the share of the area, so exact but for the slope inside a ring (below 0.5 %).
  const auto heaped = wedge_densities(column(kN, 2, [](double share) { return 0.024 - 0.008 * share; }), c, cylinder(1));
  EXPECT_NEAR(mean(heaped) / (mass_of(kN) / (area * 0.02)), 1, 0.012);
  EXPECT_TRUE(std::isnan(wedge_densities({}, c, cylinder(1)).front()));
}
TEST(TappedDensity, an_exponential_curve_gives_its_parameters) {
  for (const double tau : {2.0, 8.0, 25.0}) {
    std::vector<double> curve;
    for (int n = 0; n <= 40; ++n) curve.push_back(1150 - 120 * std::exp(-n / tau));
    const TapFit fit = fit_tapping(curve);
    EXPECT_NEAR(fit.tau / tau, 1, 1e-6);  // exact data: what the search leaves
    EXPECT_NEAR(fit.final_density, 1150, 1e-3);
    EXPECT_NEAR(fit.poured, 1030, 1e-3);
    EXPECT_NEAR(fit.r2, 1, 1e-9);
  }
  EXPECT_TRUE(std::isnan(fit_tapping({1000, 1000, 1000, 1000, 1000}).tau));
  EXPECT_TRUE(std::isnan(fit_tapping({1000, 1100}).tau));
  // Not an exponential: a step after 20 taps. The fit must not claim to explain it.
  std::vector<double> step;
  for (int n = 0; n <= 40; ++n) step.push_back(n < 20 ? 1000 : 1100);
  EXPECT_LT(fit_tapping(step).r2, 0.9);
}
CaseResult tapped(int taps, double tau, double gain) {
  CaseResult r;
  r.snapshots.resize(1);
  constexpr int kN = 20000;
  for (int n = 0; n <= taps; ++n) {
    const double height = 0.02 / (1 + gain * (1 - std::exp(-n / tau)));
    r.snapshots[0].push_back(column(kN, 40 + static_cast<std::uint64_t>(n), [=](double) { return height; }));
  }
  return r;
}
TEST(TappedDensity, kpis_of_a_known_experiment) {
  const Case c = synthetic::mono_case(kGrain);
  const RigResult out = measure(cylinder(40), c, tapped(40, 6, 0.12));
  const double poured = mass_of(20000) / (std::numbers::pi * kRadius * kRadius * 0.02);
  // 20000 random points: heights to 0.41 % per frame; ratios of two frames 0.6 %; four of them. The fit averages over many frames.
  EXPECT_NEAR(kpi(out.kpis, "poured_density_kg_m3").value / poured, 1, 0.016);
  EXPECT_NEAR(kpi(out.kpis, "hausner_ratio").value, 1.12, 4 * 0.006 * 1.12);
  EXPECT_NEAR(kpi(out.kpis, "final_density_kg_m3").value / poured, 1.12, 0.01);
  EXPECT_NEAR(kpi(out.kpis, "taps_to_half").value, 6 * std::numbers::ln2, 1.5);
  const double error = kpi(out.kpis, "hausner_ratio").standard_error;
  EXPECT_GT(error, 0.001);
  EXPECT_LT(error, 0.03);
  EXPECT_TRUE(out.warnings.empty()) << out.warnings.front();
  EXPECT_EQ(out.tables.at(0).columns.at(0).values.size(), 41u);
}
TEST(TappedDensity, an_unfinished_curve_and_missing_frames_are_told) {
  const Case c = synthetic::mono_case(kGrain);
  const RigResult rising = measure(cylinder(10), c, tapped(10, 60, 0.8));
  ASSERT_FALSE(rising.warnings.empty());
  EXPECT_NE(rising.warnings.back().find("has not levelled off"), std::string::npos);
  const RigResult missing = measure(cylinder(50), c, tapped(40, 4, 0.12));
  ASSERT_FALSE(missing.warnings.empty());
  EXPECT_NE(missing.warnings.front().find("only 41 of 51"), std::string::npos);
  CaseResult none;
  none.snapshots.resize(1);
  EXPECT_TRUE(std::isnan(kpi(measure(cylinder(5), c, none).kpis, "hausner_ratio").value));
}
}  // namespace
}  // namespace venato::dem::rigs::tapped_density
