#include "dem/psd/size_distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "base/rng.h"

namespace venato::dem {
namespace {
constexpr double kUm = 1e-6;
constexpr double kUncut = 5000 * kUm;  // far beyond every tail: e^-(5000/400)^2.5 = 0
SizeDistribution weibull(double scale_um, double shape, double lower_um, double upper_m = kUncut) {
  return {scale_um * kUm, shape, lower_um * kUm, upper_m};
}

struct Quantiles {
  double scale_um, shape, d10_um, d50_um, d90_um;
};

TEST(SizeDistribution, mass_quantiles_of_the_three_spray_dried_laws) {
  // verification.md 7.4 prints two decimals of a micrometre: half a unit of the last digit. The law there has no lower cut; 1e-3 um stands in.
  for (const Quantiles& q :
       {Quantiles{350, 2.5, 142.28, 302.27, 488.60}, Quantiles{375, 2.75, 165.44, 328.21, 507.86}, Quantiles{400, 3, 188.92, 354.00, 528.20}}) {
    const SizeDistribution psd = weibull(q.scale_um, q.shape, 1e-3);
    EXPECT_NEAR(mass_quantile(psd, 0.1) / kUm, q.d10_um, 0.005);
    EXPECT_NEAR(mass_quantile(psd, 0.5) / kUm, q.d50_um, 0.005);
    EXPECT_NEAR(mass_quantile(psd, 0.9) / kUm, q.d90_um, 0.005);
  }
}

TEST(SizeDistribution, quantile_inverts_cdf) {
  const SizeDistribution psd = weibull(375, 2.75, 100, 900 * kUm);
  for (double u : {0.0, 1e-9, 0.01, 0.5, 0.99, 1 - 1e-9, 1.0}) EXPECT_NEAR(mass_cdf(psd, mass_quantile(psd, u)), u, 1e-12);  // rounding of pow
  EXPECT_EQ(mass_cdf(psd, 99 * kUm), 0);
  EXPECT_EQ(mass_cdf(psd, 901 * kUm), 1);
  EXPECT_THROW(mass_quantile(psd, 1.1), UsageError);
  EXPECT_THROW(mass_quantile(psd, std::numeric_limits<double>::quiet_NaN()), UsageError);
}

TEST(SizeDistribution, grains_per_gram_of_the_reference_table) {
  struct Row {
    double cut_um, n350, n375, n400;
  };
  // verification.md 7.4, rho 2000, four digits given: 5e-4 relative covers the last one.
  for (const Row& row : {Row{50, 1.668e5, 1.188e5, 8.466e4}, Row{100, 8.455e4, 6.827e4, 5.452e4}, Row{150, 5.124e4, 4.446e4, 3.802e4},
                         Row{200, 3.364e4, 3.062e4, 2.745e4}}) {
    const auto per_gram = [&](double scale, double shape) { return 1e-3 / mean_grain_mass(weibull(scale, shape, row.cut_um), 2000, 1); };
    EXPECT_NEAR(per_gram(350, 2.5) / row.n350, 1, 5e-4) << row.cut_um;
    EXPECT_NEAR(per_gram(375, 2.75) / row.n375, 1, 5e-4) << row.cut_um;
    EXPECT_NEAR(per_gram(400, 3) / row.n400, 1, 5e-4) << row.cut_um;
  }
}

double grain_mass(double d, double rho) { return rho * std::numbers::pi / 6 * d * d * d; }

TEST(SizeDistribution, samples_by_number_reproduce_the_mass_law) {
  // verification.md 7.4 proposes 1e5 grains and KS < 0.005. Weighted by mass, 1e5 grains count as few as 1.5e4 and a perfect sampler's KS is
  // 0.003-0.007 for the broadest law (0.0050 measured): the limit is kept and the sample is four times as large.
  constexpr std::size_t kGrains = 400'000;
  for (const SizeDistribution& psd : {weibull(350, 2.5, 100), weibull(375, 2.75, 100), weibull(400, 3, 100)}) {
    std::vector<double> d = sample_diameters(psd, 1, kGrains, 7, stream_id("tests/psd"));
    double mass = 0;
    for (double x : d) mass += grain_mass(x, 2000);
    // Relative spread of a grain's mass is about 2.2: standard error of the mean 0.7 %; the reference asks for 1 %.
    EXPECT_NEAR(1e-3 / mean_grain_mass(psd, 2000, 1) / (1e-3 * kGrains / mass), 1, 0.01);
    std::sort(d.begin(), d.end());
    double below = 0, ks = 0;
    for (double x : d) {
      const double law = mass_cdf(psd, x);
      ks = std::max(ks, std::abs(law - below / mass));
      below += grain_mass(x, 2000);
      ks = std::max(ks, std::abs(law - below / mass));
    }
    EXPECT_LT(ks, 0.005);  // verification.md 7.4
    RecordProperty("ks", std::to_string(ks));
    EXPECT_NEAR(below / mass, 1, 1e-12);  // total mass exact: same sum, rounding only
  }
}

TEST(SizeDistribution, drawing_by_number_as_if_it_were_by_mass_is_noticed) {
  // Negative control: the classic fault. Diameters drawn from the mass law, one grain each, must be far from the mass law.
  const SizeDistribution psd = weibull(375, 2.75, 100);
  std::vector<double> d(20'000);
  for (std::size_t k = 0; k < d.size(); ++k) d[k] = mass_quantile(psd, Rng(7, stream_id("tests/psd"), k).uniform());
  std::sort(d.begin(), d.end());
  double mass = 0, below = 0, ks = 0;
  for (double x : d) mass += grain_mass(x, 2000);
  for (double x : d) {
    below += grain_mass(x, 2000);
    ks = std::max(ks, std::abs(mass_cdf(psd, x) - below / mass));
  }
  EXPECT_GT(ks, 0.2);
}

/// Number CDF by brute force: midpoint sums of d^-3 times the mass density on a grid a hundred times finer in its own variable.
double number_cdf_by_hand(const SizeDistribution& psd, double d) {
  const auto density = [&](double x) { return std::pow(x / psd.scale_m, psd.shape - 4) * std::exp(-std::pow(x / psd.scale_m, psd.shape)); };
  const auto integral = [&](double to) {
    constexpr int kSteps = 200'000;
    const double h = (to - psd.lower_cut_m) / kSteps;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) sum += density(psd.lower_cut_m + (k + 0.5) * h);
    return sum * h;
  };
  return integral(d) / integral(psd.upper_cut_m);
}

TEST(SizeDistribution, inverse_transform_is_accurate) {
  const SizeDistribution psd = weibull(350, 2.5, 60, 1200 * kUm);
  const std::vector<double> d = sample_diameters(psd, 1, 8, 11, stream_id("tests/psd"));
  for (std::size_t k = 0; k < d.size(); ++k) {
    const double u = Rng(11, stream_id("tests/psd"), k).uniform();
    EXPECT_NEAR(number_cdf_by_hand(psd, d[k]), u, 1e-6);  // header's promise; the midpoint sum itself is good to 1e-8
  }
}

TEST(SizeDistribution, same_grain_same_size_wherever_it_is_drawn) {
  const SizeDistribution psd = weibull(375, 2.75, 100, 800 * kUm);
  const auto all = sample_diameters(psd, 2, 100, 3, stream_id("tests/psd"));
  const auto tail = sample_diameters(psd, 2, 40, 3, stream_id("tests/psd"), 60);
  EXPECT_TRUE(std::equal(tail.begin(), tail.end(), all.begin() + 60));
  EXPECT_NE(all, sample_diameters(psd, 2, 100, 4, stream_id("tests/psd")));
  for (double d : all) EXPECT_TRUE(d >= 200 * kUm && d <= 1600 * kUm) << d;
}

TEST(SizeDistribution, monodisperse) {
  const SizeDistribution psd{0, 0, 400 * kUm, 400 * kUm};
  EXPECT_EQ(sample_diameters(psd, 3, 5, 1, 2), std::vector<double>(5, 1200 * kUm));
  EXPECT_NEAR(mean_grain_mass(psd, 1900, 1), 6.366961e-8, 1e-14);  // verification.md 0.4, seven digits
  EXPECT_EQ(mass_quantile(psd, 0.3), 400 * kUm);
}

TEST(SizeDistribution, coarse_graining_scales_the_mass_by_its_cube) {
  const SizeDistribution psd = weibull(400, 3, 150);
  EXPECT_NEAR(mean_grain_mass(psd, 2000, 3) / mean_grain_mass(psd, 2000, 1), 27, 1e-12 * 27);
}

TEST(SizeDistribution, far_tail_does_not_underflow) {
  const SizeDistribution psd = weibull(100, 3, 1100, 1200 * kUm);  // e^-1331 of the uncut law
  const double d = mass_quantile(psd, 0.5);
  EXPECT_TRUE(d > 1100 * kUm && d < 1101 * kUm) << d;
  EXPECT_NEAR(mass_cdf(psd, d), 0.5, 1e-9);
}

TEST(SizeDistribution, refuses_impossible_laws) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const SizeDistribution& bad :
       {SizeDistribution{4e-4, 3, 0, 1e-3}, SizeDistribution{4e-4, 3, -1e-4, 1e-3}, SizeDistribution{4e-4, 3, 5e-4, 4e-4},
        SizeDistribution{4e-4, 3, 1e-4, inf}, SizeDistribution{0, 3, 1e-4, 1e-3}, SizeDistribution{4e-4, 0, 1e-4, 1e-3},
        SizeDistribution{nan, 3, 1e-4, 1e-3}, SizeDistribution{4e-4, nan, 1e-4, 1e-3}, SizeDistribution{4e-4, 3, nan, 1e-3}}) {
    EXPECT_THROW(mass_cdf(bad, 3e-4), UsageError);
    EXPECT_THROW(mass_quantile(bad, 0.5), UsageError);
    EXPECT_THROW(mean_grain_mass(bad, 2000, 1), UsageError);
    EXPECT_THROW(sample_diameters(bad, 1, 1, 1, 1), UsageError);
  }
  EXPECT_THROW(mean_grain_mass(weibull(400, 3, 100), 0, 1), UsageError);
  EXPECT_THROW(sample_diameters(weibull(400, 3, 100), 0, 1, 1, 1), UsageError);
}
}  // namespace
}  // namespace venato::dem
