/// The Weibull law without a lower cut has no finite number of grains for shape <= 3: what the cut costs and why it is demanded.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "dem/psd/size_distribution.h"

namespace venato::dem {
namespace {
constexpr double kUm = 1e-6, kUncut = 5000 * kUm;
SizeDistribution weibull(double scale_um, double shape, double lower_um) { return {scale_um * kUm, shape, lower_um * kUm, kUncut}; }
double grains_per_gram(double scale_um, double shape, double lower_um) { return 1e-3 / mean_grain_mass(weibull(scale_um, shape, lower_um), 2000, 1); }

struct Row {
  double scale_um, shape, mean_um, lost_100, lost_150, d32_um;  ///< mass mean; mass below 100 and 150 um [%]; Sauter diameter above 100 um
};
constexpr Row kRows[] = {{350, 2.5, 310.54, 4.27, 11.33, 270.5}, {375, 2.75, 333.70, 2.60, 7.73, 290.5}, {400, 3, 357.19, 1.55, 5.14, 312.3}};

/// Mean by mass = integral of the quantile function; midpoint sum of 1e5 terms. Half a unit of the printed digit.
TEST(WeibullCut, MassMean) {
  for (const Row& row : kRows) {
    const SizeDistribution psd = weibull(row.scale_um, row.shape, 1e-3);
    double sum = 0;
    for (int k = 0; k < 100000; ++k) sum += mass_quantile(psd, (k + .5) / 100000) / 100000;
    EXPECT_NEAR(sum / kUm, row.mean_um, .006) << row.shape;
  }
}
/// Mass that a cut gives up, to the printed .01 %, and the Sauter diameter of what is left: d32 = 1 / (integral of dF / d), and of drawn grains 1 %.
TEST(WeibullCut, MassLostAndSauterDiameter) {
  for (const Row& row : kRows) {
    const SizeDistribution whole = weibull(row.scale_um, row.shape, 1e-3), cut = weibull(row.scale_um, row.shape, 100);
    EXPECT_NEAR(100 * mass_cdf(whole, 100 * kUm), row.lost_100, .006);
    EXPECT_NEAR(100 * mass_cdf(whole, 150 * kUm), row.lost_150, .006);
    double inverse = 0;
    for (int k = 0; k < 100000; ++k) inverse += 1 / mass_quantile(cut, (k + .5) / 100000) / 100000;
    EXPECT_NEAR(1 / inverse / kUm, row.d32_um, .06);
    double d2 = 0, d3 = 0;
    for (const double d : sample_diameters(cut, 1, 100000, 3, stream_id("tests/psd"))) d2 += d * d, d3 += d * d * d;
    EXPECT_NEAR(d3 / d2 / kUm / row.d32_um, 1, .01);
  }
}
/// Without a cut the number of grains per gram grows without end as the cut goes to zero, like cut^(shape - 3) plus a constant: from decade to decade
/// the increase is 10^(3 - shape) times the last one (1 %), for shape 3 the same again; for shape 4 the number settles (1 %). So a lower cut of zero
/// is refused. Negative control: the number of the law with (next to) no cut, 0.1 um, misses the number at 100 um 30 times over.
TEST(WeibullCut, NumberDivergesWithoutACut) {
  for (const double shape : {2.5, 2.75, 3.}) {
    const double first = grains_per_gram(375, shape, .1) - grains_per_gram(375, shape, 1),
                 second = grains_per_gram(375, shape, .01) - grains_per_gram(375, shape, .1);
    EXPECT_NEAR(second / first / std::pow(10, 3 - shape), 1, .01) << shape;
    EXPECT_GT(first, 1e4) << shape;
  }
  EXPECT_NEAR(grains_per_gram(400, 4, .1) / grains_per_gram(400, 4, 1), 1, .01);
  EXPECT_THROW(mean_grain_mass(weibull(375, 2.75, 0), 2000, 1), UsageError);
  auto is_number_of_cut_law = [](double n) { return std::abs(n / 8.455e4 - 1) <= .01; };  // shape 2.5, 100 um
  EXPECT_TRUE(is_number_of_cut_law(grains_per_gram(350, 2.5, 100)));
  EXPECT_FALSE(is_number_of_cut_law(grains_per_gram(350, 2.5, .1)));
  EXPECT_GT(grains_per_gram(350, 2.5, .1) / 8.455e4, 30);
}
}  // namespace
}  // namespace venato::dem
