#include "dem/contact/luding/law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/rng.h"

namespace venato::dem {
namespace {
// Test vector of multiscale.md 3.1. Its numbers have seven digits: 1e-6 relative.
constexpr Luding kLaw{200, 1000, 100, 0.05};
constexpr double kR = 0.25e-3, kDigits = 1e-6;
const double kLimit = luding_plastic_limit(kLaw, kR);

/// Work done on the contact going from one overlap to another, midpoint rule of n steps. The branches are straight lines, so the only quadrature
/// error is the one step in which a corner lies: (slope change)/8 * step^2, below 1e-9 of the energies with 2e5 steps.
double work(const Luding& law, double from, double to, LudingHistory& h, int n = 200'000) {
  const double step = (to - from) / n;
  double sum = 0;
  for (int k = 0; k < n; ++k) sum += luding_force(law, kR, from + (k + 0.5) * step, h) * step;
  luding_force(law, kR, to, h);
  return sum;
}

TEST(Luding, test_vector) {
  EXPECT_NEAR(kLimit / 3.125e-5, 1, kDigits);
  LudingHistory h;
  const double top = kLimit / 2;
  EXPECT_NEAR(luding_force(kLaw, kR, top, h) / (200 * top), 1, 1e-12);
  const double k2 = luding_unloading_stiffness(kLaw, kR, h.overlap_max_m);
  EXPECT_NEAR(k2 / 600, 1, kDigits);
  const double d0 = (1 - 200 / k2) * top;
  EXPECT_NEAR(d0 / 1.041667e-5, 1, kDigits);
  EXPECT_NEAR(luding_force(kLaw, kR, d0, h), 0, 1e-15);  // 1e-12 of the forces here
  const double d_min = 8.928571e-6;
  EXPECT_NEAR(luding_force(kLaw, kR, d_min, h) / -8.928571e-4, 1, kDigits);
  EXPECT_NEAR((k2 - 200) / (k2 + 100) * top / d_min, 1, kDigits);
}

TEST(Luding, energies_of_the_test_vector) {
  LudingHistory h;
  const double top = kLimit / 2, d0 = 1.0 / 96 * 1e-3;
  EXPECT_NEAR(work(kLaw, 0, top, h) / 2.441406e-8, 1, kDigits);
  EXPECT_NEAR(work(kLaw, top, d0, h) / -8.138021e-9, 1, kDigits);
  EXPECT_NEAR(work(kLaw, d0, 0, h) / 4.650298e-9, 1, kDigits);
}

TEST(Luding, dry_restitution_is_the_root_of_the_stiffness_ratio) {
  const Luding dry{200, 1000, 0, 0.05};
  LudingHistory h;
  const double top = kLimit / 2, in = work(dry, 0, top, h), out = -work(dry, top, 0, h);
  EXPECT_NEAR(std::sqrt(out / in), std::sqrt(200.0 / 600), kDigits);
}

TEST(Luding, reload_meets_the_virgin_curve) {
  LudingHistory h;
  luding_force(kLaw, kR, 1e-5, h);
  luding_force(kLaw, kR, 0.9e-5, h);
  EXPECT_NEAR(luding_force(kLaw, kR, 1e-5 * (1 - 1e-9), h) / (200 * 1e-5), 1, 1e-8);  // slope ratio k2/k1 = 2.3 times 1e-9
  EXPECT_NEAR(luding_force(kLaw, kR, 1.2e-5, h) / (200 * 1.2e-5), 1, 1e-12);
  // After pulling along the adhesive limit as well: the new largest overlap lies on the virgin line.
  luding_force(kLaw, kR, 1e-6, h);
  const double again = h.overlap_max_m;
  EXPECT_LT(again, 1.2e-5);
  EXPECT_NEAR(luding_force(kLaw, kR, again, h) / (200 * again), 1, 1e-12);
}

TEST(Luding, the_adhesive_limit_is_followed_without_jumps) {
  LudingHistory h;
  luding_force(kLaw, kR, kLimit / 2, h);
  luding_force(kLaw, kR, 8.9e-6, h);  // just past d_min
  for (int k = 1; k <= 1000; ++k) {
    const double d = 8.9e-6 * (1 - k / 1001.0);
    EXPECT_NEAR(luding_force(kLaw, kR, d, h) / (-100 * d), 1, 1e-12) << k;
  }
  // Turning round in the middle of the limit: up the new elastic line, down again to the same force.
  luding_force(kLaw, kR, kLimit / 2, h);
  const double pulled = luding_force(kLaw, kR, 5e-6, h);
  luding_force(kLaw, kR, 5.5e-6, h);
  EXPECT_NEAR(luding_force(kLaw, kR, 5e-6, h) / pulled, 1, 1e-9);
}

TEST(Luding, beyond_the_plastic_limit_it_is_elastic) {
  LudingHistory h;
  const double past = 1.5 * kLimit, force = luding_force(kLaw, kR, past, h);
  EXPECT_NEAR(force / (1000 * (past - 0.8 * kLimit)), 1, 1e-12);
  EXPECT_NEAR(luding_force(kLaw, kR, kLimit, h) / (200 * kLimit), 1, 1e-12);  // continuous, and the same line back
  EXPECT_NEAR(luding_force(kLaw, kR, past, h) / force, 1, 1e-15);
  EXPECT_NEAR(work(kLaw, kLimit, past, h) + work(kLaw, past, kLimit, h), 0, 1e-12 * past * force);
}

TEST(Luding, equal_stiffness_is_hooke) {
  const Luding hooke{200, 200, 100, 0.05};
  LudingHistory h;
  for (double d : {1e-6, 5e-5, 3e-6, 1e-9, 2e-5}) EXPECT_NEAR(luding_force(hooke, kR, d, h) / (200 * d), 1, 1e-12);
}

TEST(Luding, no_closed_cycle_gives_energy) {
  for (std::uint64_t path = 0; path < 200; ++path) {
    LudingHistory h;
    Rng rng(1, stream_id("tests/luding"), path);
    double at = 0, in = 0, scale = 0;
    for (int turn = 0; turn < 6; ++turn) {
      const double to = turn == 5 ? 0 : 1.3 * kLimit * rng.uniform();
      in += work(kLaw, at, to, h, 20'000);
      scale += 0.5 * 1000 * to * to;
      at = to;
    }
    EXPECT_GE(in, -1e-7 * scale) << path;  // corners cost (step)^2 ~ 1e-8 with 2e4 steps
  }
}

TEST(Luding, opening_forgets) {
  LudingHistory h;
  luding_force(kLaw, kR, kLimit, h);
  EXPECT_EQ(luding_force(kLaw, kR, 0, h), 0);
  EXPECT_EQ(h.overlap_max_m, 0);
}

TEST(Luding, refuses_impossible_parameters) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Luding& bad :
       {Luding{0, 1000, 0, .05}, Luding{200, 100, 0, .05}, Luding{200, 1000, -1, .05}, Luding{200, 1000, 0, 0}, Luding{nan, 1000, 0, .05}})
    EXPECT_THROW(check_luding(bad), UsageError);
  EXPECT_NO_THROW(check_luding(kLaw));
}
}  // namespace
}  // namespace venato::dem
