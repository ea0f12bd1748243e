#include "dem/contact/thornton_ning/law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"

namespace venato::dem {
namespace {
// Test vector of multiscale.md 3.1: E* 5.333 MPa, R* 0.25 mm, m* 5.236e-7 kg, p_y 135.8 kPa, V 0.1 m/s.
constexpr ThorntonNing kLaw{5.333e6, 135.8e3};
constexpr double kR = 0.25e-3, kMass = 5.236e-7, kSpeed = 0.1;

double hertz(double d) { return 4.0 / 3 * kLaw.e_eff_pa * std::sqrt(kR) * std::pow(d, 1.5); }

/// Midpoint rule in the overlap; error of d^1.5 at its root and of corners ~ n^-1.5: 1e-7 of the energy with 2e5 steps.
double work(const ThorntonNing& law, double from, double to, ThorntonNingHistory& h, int n = 200'000) {
  const double step = (to - from) / n;
  double sum = 0;
  for (int k = 0; k < n; ++k) sum += thornton_ning_force(law, kR, from + (k + 0.5) * step, h) * step;
  thornton_ning_force(law, kR, to, h);
  return sum;
}

double energy_at(double d) {
  const double d_y = thornton_ning_yield_overlap(kLaw, kR), plastic = d - d_y;
  return 0.4 * hertz(d_y) * d_y + hertz(d_y) * plastic + 0.5 * std::numbers::pi * kLaw.yield_pressure_pa * kR * plastic * plastic;
}
/// Overlap at which the impact energy is used up, by bisection.
double impact_overlap() {
  double low = thornton_ning_yield_overlap(kLaw, kR), high = kR;
  for (int k = 0; k < 200; ++k) (energy_at(0.5 * (low + high)) < 0.5 * kMass * kSpeed * kSpeed ? low : high) = 0.5 * (low + high);
  return low;
}

TEST(ThorntonNing, test_vector) {
  // Five digits are printed: 1e-5 relative covers half a unit of the last one; e also carries the rounding of the inputs (E* 5.333 for 16/3 MPa
  // alone moves it by 1e-5).
  const double d = impact_overlap();
  EXPECT_NEAR(d / 7.1389e-6, 1, 1e-5);
  const ThorntonNingUnloading branch = thornton_ning_unloading(kLaw, kR, d);
  EXPECT_NEAR(branch.force_max_n / 7.4719e-4, 1, 1e-5);
  EXPECT_NEAR(branch.r_p_m / kR, 2.870, 5e-4);
  const double rebound = 0.4 * branch.force_max_n * (d - branch.overlap_p_m);
  EXPECT_NEAR(std::sqrt(rebound / (0.5 * kMass * kSpeed * kSpeed)), 0.53286, 2.5e-5);
  EXPECT_NEAR(thornton_ning_restitution(kSpeed, thornton_ning_yield_speed(kLaw, kR, kMass)), 0.53287, 2.5e-5);
}

TEST(ThorntonNing, energies_by_quadrature_match_the_closed_form) {
  const double d = impact_overlap();
  ThorntonNingHistory h;
  const double in = work(kLaw, 0, d, h), out = -work(kLaw, d, 0, h);
  EXPECT_NEAR(in / (0.5 * kMass * kSpeed * kSpeed), 1, 1e-6);
  const ThorntonNingUnloading branch = thornton_ning_unloading(kLaw, kR, d);
  EXPECT_NEAR(out / (0.4 * branch.force_max_n * (d - branch.overlap_p_m)), 1, 1e-6);
  // The closed form is exact for this force law.
  EXPECT_NEAR(std::sqrt(out / in) / thornton_ning_restitution(kSpeed, thornton_ning_yield_speed(kLaw, kR, kMass)), 1, 1e-6);
}

TEST(ThorntonNing, both_forms_of_the_flattened_radius_agree) {
  const double d = 7e-6, d_y = thornton_ning_yield_overlap(kLaw, kR);
  const ThorntonNingUnloading branch = thornton_ning_unloading(kLaw, kR, d);
  const double other = 4 * kLaw.e_eff_pa / (3 * branch.force_max_n) *
                       std::pow((2 * branch.force_max_n + hertz(d_y)) / (2 * std::numbers::pi * kLaw.yield_pressure_pa), 1.5);
  EXPECT_NEAR(branch.r_p_m / other, 1, 1e-12);
}

TEST(ThorntonNing, yield_speed_and_fast_limit) {
  const double exact = thornton_ning_yield_speed(kLaw, kR, kMass);
  const double printed = 3.194 * std::sqrt(std::pow(kLaw.yield_pressure_pa, 5) * std::pow(kR, 3) / (std::pow(kLaw.e_eff_pa, 4) * kMass));
  EXPECT_NEAR(printed / exact, 1, 2e-4);  // four digits of 3.194
  EXPECT_EQ(thornton_ning_restitution(0.5 * exact, exact), 1);
  EXPECT_NEAR(thornton_ning_restitution(exact * (1 + 1e-12), exact), 1, 1e-9);
  EXPECT_NEAR(thornton_ning_restitution(1e8 * exact, exact) / (1.185 * std::pow(1e-8, 0.25)), 1, 5e-4);  // four digits of 1.185
}

TEST(ThorntonNing, loading_and_unloading_are_continuous) {
  const double d_y = thornton_ning_yield_overlap(kLaw, kR);
  ThorntonNingHistory h;
  EXPECT_NEAR(thornton_ning_force(kLaw, kR, d_y, h) / hertz(d_y), 1, 1e-12);
  EXPECT_NEAR(thornton_ning_force(kLaw, kR, d_y * (1 + 1e-9), h) / hertz(d_y), 1, 1e-8);
  const double top = thornton_ning_force(kLaw, kR, 5 * d_y, h);
  EXPECT_NEAR(thornton_ning_force(kLaw, kR, 5 * d_y * (1 - 1e-9), h) / top, 1, 1e-7);
  const ThorntonNingUnloading branch = thornton_ning_unloading(kLaw, kR, 5 * d_y);
  EXPECT_GT(branch.overlap_p_m, 0);
  EXPECT_EQ(thornton_ning_force(kLaw, kR, 0.9 * branch.overlap_p_m, h), 0);  // no adhesion
  EXPECT_NEAR(thornton_ning_force(kLaw, kR, 5 * d_y, h) / top, 1, 1e-15);    // reload meets the virgin curve
}

TEST(ThorntonNing, never_yielding_is_hertz) {
  for (double p_y : {1e12, std::numeric_limits<double>::infinity()}) {
    const ThorntonNing elastic{kLaw.e_eff_pa, p_y};
    ThorntonNingHistory h;
    for (double d : {1e-6, 5e-5, 3e-6, 1e-9, 2e-5}) EXPECT_NEAR(thornton_ning_force(elastic, kR, d, h) / hertz(d), 1, 1e-12);
  }
}

TEST(ThorntonNing, no_closed_cycle_gives_energy) {
  for (std::uint64_t path = 0; path < 100; ++path) {
    ThorntonNingHistory h;
    Rng rng(1, stream_id("tests/thornton_ning"), path);
    double at = 0, in = 0, scale = 0;
    for (int turn = 0; turn < 6; ++turn) {
      const double to = turn == 5 ? 0 : 2e-5 * rng.uniform();
      in += work(kLaw, at, to, h, 20'000);
      scale += hertz(to) * to;
      at = to;
    }
    EXPECT_GE(in, -1e-6 * scale) << path;  // quadrature, see work()
  }
}

TEST(ThorntonNing, opening_forgets_and_bad_parameters_are_refused) {
  ThorntonNingHistory h;
  thornton_ning_force(kLaw, kR, 1e-5, h);
  EXPECT_EQ(thornton_ning_force(kLaw, kR, -1e-9, h), 0);
  EXPECT_EQ(h.overlap_max_m, 0);
  EXPECT_THROW(check_thornton_ning({0, 1e5}), UsageError);
  EXPECT_THROW(check_thornton_ning({1e7, 0}), UsageError);
  EXPECT_THROW(check_thornton_ning({1e7, std::nan("")}), UsageError);
}
}  // namespace
}  // namespace venato::dem
