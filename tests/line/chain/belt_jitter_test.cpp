#include "line/chain/belt_jitter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/rng.h"
namespace venato::line {
namespace {
constexpr double kLength = 2.0;
const BeltJitter kJitter{0.002, 0.2};

Bed random_bed() {
  BedGrid g;
  g.nx = 3, g.ny = 400, g.nz = 2, g.pitch_m = kLength / 400;
  Bed bed = make_bed(g, {"a", "b"});
  Rng rng(1, stream_id("tests/belt_jitter"));
  for (auto& m : bed.mass)
    for (auto& v : m) v = rng.uniform();
  return bed;
}

TEST(BeltJitter, HasTheAskedSizeAndLength) {
  // Mean square over 200 seeds; 10 mm of independent stretches per strip and 200 strips give a relative standard error of the variance of about
  // sqrt(2 / 2000) = 3 %; 5 sigma.
  double square = 0, product = 0;
  int n = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const JitterField f(kJitter, kLength, seed);
    for (int k = 0; k < 20; ++k, ++n) {
      const double y = kLength * k / 20;
      square += std::pow(f.displacement_m(y), 2);
      product += f.displacement_m(y) * f.displacement_m(y + kJitter.correlation_m);
    }
  }
  EXPECT_NEAR(square / n, 4e-6, 0.15 * 4e-6);
  // Correlation exp(-1) at one correlation length, less the constant wave that is left out (its share of the variance: sqrt(pi) * 0.2 / 2 = 0.18):
  // (exp(-1) - 0.18) / 0.82 = 0.23.
  EXPECT_NEAR(product / square, 0.23, 0.07);
}

TEST(BeltJitter, IsPeriodicAndSmoothAndInvertible) {
  const JitterField f(kJitter, kLength, 3);
  EXPECT_NEAR(f.displacement_m(0.3), f.displacement_m(0.3 + kLength), 1e-12);
  const double h = 1e-6;
  EXPECT_NEAR(f.slope(0.7), (f.displacement_m(0.7 + h) - f.displacement_m(0.7 - h)) / (2 * h), 1e-8);
  for (double y : {0.0, 0.4, 1.1, 1.99}) EXPECT_NEAR(f.undo(y + f.displacement_m(y)), y, 1e-11);
}

TEST(BeltJitter, KeepsEveryPowdersMassInEveryLayer) {
  const Bed bed = random_bed();
  const Bed moved = move_bed(bed, JitterField(kJitter, kLength, 3), 2);
  const std::size_t layer = bed.grid.columns();
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t z = 0; z < 2; ++z) {
      double in = 0, out = 0;
      for (std::size_t c = z * layer; c < (z + 1) * layer; ++c) in += bed.mass[k][c], out += moved.mass[k][c];
      EXPECT_NEAR(out, in, 1e-12 * in);
    }
  EXPECT_NE(moved.mass[0], bed.mass[0]);
}

TEST(BeltJitter, MovesALineWhereTheFieldSays) {
  Bed bed = random_bed();
  for (auto& m : bed.mass) std::fill(m.begin(), m.end(), 0.0);
  const JitterField f(kJitter, kLength, 3);
  const int row = 150;
  bed.mass[0][static_cast<std::size_t>(row * bed.grid.nx)] = 1;
  const Bed moved = move_bed(bed, f, 1);
  double mass = 0, moment = 0;
  for (int j = 0; j < bed.grid.ny; ++j) {
    const double m = moved.mass[0][static_cast<std::size_t>(j * bed.grid.nx)];
    mass += m, moment += m * (j + 0.5) * bed.grid.pitch_m;
  }
  const double y = (row + 0.5) * bed.grid.pitch_m;
  // The landing interval is spread evenly over grid cells, which moves the centroid by less than a tenth of a 5 mm cell for a shift within a cell or
  // two.
  EXPECT_NEAR(moment / mass, y + f.displacement_m(y), 0.5e-3);
}

TEST(BeltJitter, SameBytesForAnyThreadCount) {
  const Bed bed = random_bed();
  const JitterField f(kJitter, kLength, 3);
  EXPECT_EQ(move_bed(bed, f, 1).mass, move_bed(bed, f, 4).mass);
}

TEST(BeltJitter, FoldIsRefused) { EXPECT_THROW(move_bed(random_bed(), JitterField({0.3, 0.05}, kLength, 3), 1), WorkError); }

TEST(BeltJitter, ZeroIsIdentity) {
  const Bed bed = random_bed();
  EXPECT_EQ(move_bed(bed, JitterField({0, 0.4}, kLength, 3), 1).mass, bed.mass);
}
}  // namespace
}  // namespace venato::line
