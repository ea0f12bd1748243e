#include <gtest/gtest.h>

#include "dem/rigs/discharge/rig.h"
#include "tests/dem/rigs/synthetic.h"

namespace venato::dem::rigs::discharge {
namespace {
using synthetic::kpi;
constexpr double kGrain = 1e-3, kGravity = 9.80665, kDensity = 1100;

Config holes() {
  Config c;
  c.counter = "below";
  c.openings = {{6e-3, 0, 1}, {8e-3, 1, 2}, {10e-3, 2, 3}, {12e-3, 3, 4}};
  return c;
}
Case silo() {
  Case c = synthetic::mono_case(kGrain);
  c.counters.resize(2);
  c.counters[1].name = "below";
  return c;
}
/// Grains at a steady rate with random times: block errors as of independent grains.
void flow(std::vector<CounterRecord>& records, double from, double to, double kg_s, std::uint64_t seed, double grain_kg = 1e-6) {
  Rng rng(seed, 5);
  const auto n = static_cast<int>(kg_s * (to - from) / grain_kg);
  std::vector<double> times;
  for (int k = 0; k < n; ++k) times.push_back(from + (to - from) * rng.uniform());
  std::sort(times.begin(), times.end());
  for (const double t : times) {
    const Vec3 zero = Vec3::Zero();
    records.push_back({t, zero, zero, zero, zero, 0, grain_kg, 1e-3, 0, 0});
  }
}

TEST(Discharge, beverloos_law_comes_back_with_its_error) {
  Config config = holes();
  const double c_true = 0.55, k_true = 1.6;
  for (const bool slot : {false, true}) {
    config.slot = slot;
    config.slot_length_m = 0.02;
    std::vector<Flow> flows;
    for (const Window& w : config.openings) {
      const double f = beverloo_kg_s(config, w.size_m, kDensity, kGravity, kGrain, c_true, k_true);
      flows.push_back({f, 0.01 * f, 1});
    }
    const BeverlooFit fit = fit_beverloo(config, flows, kDensity, kGravity, kGrain);
    EXPECT_NEAR(fit.constant, c_true, 1e-9);  // exact data: rounding only
    EXPECT_NEAR(fit.empty_m, k_true * kGrain, 1e-9);
    EXPECT_NEAR(fit.r2, 1, 1e-12);
    // 1 % per flow is 0.4 % (hole) or 0.67 % (slot) of the root: errors of some per cent of C and some tenths of a grain, not zero, not the whole.
    EXPECT_GT(fit.constant_error / fit.constant, 0.005);
    EXPECT_LT(fit.constant_error / fit.constant, 0.08);
    EXPECT_GT(fit.empty_error_m, 0.02e-3);
    EXPECT_LT(fit.empty_error_m, 0.3e-3);
  }
}
TEST(Discharge, error_bars_cover_the_scatter_of_the_fit) {
  // 200 made-up experiments with 2 % noise: the scatter of the fitted k equals its mean error bar. 200 draws know a standard deviation to 5 %.
  const Config config = holes();
  Rng rng(8, 8);
  double sum = 0, squares = 0, errors = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Flow> flows;
    for (const Window& w : config.openings) {
      const double f = beverloo_kg_s(config, w.size_m, kDensity, kGravity, kGrain, 0.58, 1.4);
      double normal = -6;
      for (int k = 0; k < 12; ++k) normal += rng.uniform();
      flows.push_back({f * (1 + 0.02 * normal), 0.02 * f, 1});
    }
    const double k = fit_beverloo(config, flows, kDensity, kGravity, kGrain).empty_m;
    sum += k, squares += k * k, errors += fit_beverloo(config, flows, kDensity, kGravity, kGrain).empty_error_m;
  }
  const double mean = sum / kTrials, sd = std::sqrt(squares / kTrials - mean * mean);
  EXPECT_NEAR(sd / (errors / kTrials), 1, 0.2);
  EXPECT_NEAR(mean, 1.4e-3, 4 * sd / std::sqrt(kTrials));
}
TEST(Discharge, flows_of_a_schedule_of_holes) {
  const Config config = holes();
  const Case c = silo();
  CaseResult r;
  r.records.resize(2);
  std::uint64_t seed = 0;
  for (const Window& w : config.openings)
    flow(r.records[1], w.from_s, w.to_s, beverloo_kg_s(config, w.size_m, kDensity, kGravity, kGrain, 0.58, 1.4), ++seed);
  const RigResult out = measure(config, c, r);
  const Kpi& at8 = kpi(out.kpis, "flow_at_8_mm_g_s");
  const double truth = 1e3 * beverloo_kg_s(config, 8e-3, kDensity, kGravity, kGrain, 0.58, 1.4);
  // Random times of about n grains in 0.95 s: relative error 1 / sqrt(n).
  const double poisson = truth / std::sqrt(truth * 1e-3 * 0.95 / 1e-6);
  EXPECT_NEAR(at8.value, truth, 4 * poisson);
  EXPECT_NEAR(at8.standard_error / poisson, 1, 0.8);  // an error from 8 blocks is itself known to 27 %
  EXPECT_EQ(at8.error_from, "8 time blocks");
  EXPECT_NEAR(kpi(out.kpis, "beverloo_k").value, 1.4, 4 * kpi(out.kpis, "beverloo_k").standard_error);
  EXPECT_LT(kpi(out.kpis, "beverloo_k").standard_error, 0.3);
  EXPECT_GT(kpi(out.kpis, "beverloo_r2").value, 0.99);
  EXPECT_TRUE(std::isnan(kpi(out.kpis, "beverloo_constant").value));  // no bulk region: the density is not known, so C is not
  EXPECT_TRUE(out.warnings.empty()) << out.warnings.front();
  EXPECT_EQ(out.tables.at(0).columns.at(1).values.size(), 4u);
}
TEST(Discharge, another_law_does_not_pass_for_beverloo) {
  // Flow proportional to D, as of a belt: the root against D is no line through k d > 0.
  const Config config = holes();
  std::vector<Flow> flows;
  for (const Window& w : config.openings) flows.push_back({0.5 * w.size_m, 0.005 * w.size_m, 1});
  const BeverlooFit fit = fit_beverloo(config, flows, kDensity, kGravity, kGrain);
  EXPECT_LT(fit.empty_m, -2e-3);
}
TEST(Discharge, blocked_and_empty_are_told) {
  Config config = holes();
  config.openings.resize(2);
  const Case c = silo();
  CaseResult r;
  r.records.resize(2);
  flow(r.records[1], 0.05, 0.6, 0.01, 1);  // runs dry at 0.6 of 1 s
  const RigResult out = measure(config, c, r);
  ASSERT_EQ(out.warnings.size(), 2u);
  EXPECT_NE(out.warnings[0].find("6 mm passed only 0 %"), std::string::npos) << out.warnings[0];
  EXPECT_NE(out.warnings[1].find("fewer than 20 grains went through the opening of 8 mm"), std::string::npos) << out.warnings[1];
  EXPECT_TRUE(std::isnan(kpi(out.kpis, "flow_at_8_mm_g_s").value));
}
TEST(Discharge, bulk_density_counts_centres_in_the_region) {
  Case c = synthetic::mono_case(kGrain);
  c.box = {Vec3::Zero(), Vec3::Constant(0.01), {true, false, false}};
  Snapshot s;
  // A 10 x 10 x 10 lattice of 1 mm grains, shifted by three periods in x (positions are unwrapped).
  for (int k = 0; k < 1000; ++k) {
    s.id.push_back(k);
    s.position_m.emplace_back((k % 10 + 0.5) * 1e-3 + 0.03, (k / 10 % 10 + 0.5) * 1e-3, (k / 100 + 0.5) * 1e-3);
    s.radius_m.push_back(5e-4f);
    s.species.push_back(0);
  }
  const double lattice = 2000 * std::numbers::pi / 6;
  EXPECT_NEAR(bulk_density(s, c, Vec3::Zero(), Vec3::Constant(0.01)) / lattice, 1, 1e-6);  // single precision radii
  EXPECT_NEAR(bulk_density(s, c, Vec3(0.002, 0.002, 0.002), Vec3(0.008, 0.008, 0.008)) / lattice, 1, 1e-6);
  EXPECT_NEAR(bulk_density(s, c, Vec3::Zero(), Vec3(0.01, 0.01, 0.02)) / lattice, 0.5, 1e-6);
}
}  // namespace
}  // namespace venato::dem::rigs::discharge
