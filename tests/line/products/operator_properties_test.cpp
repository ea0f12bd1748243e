// MS1-MS6 of multiscale.md 2.5 on random and Gaussian operators.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/line/products/random_operator.h"

using namespace venato;
using namespace venato::line;

namespace {
constexpr double kPitch = 1e-3, kSpeed = 0.1;

std::vector<Operator> random_chain() {
  return {random_operator(4, 5, 7, 10e-3, 1e-3, 21), random_operator(4, 9, 3, 4e-3, 1.7e-3, 22), random_operator(1, 3, 5, 10e-3, 1e-3, 23)};
}

// Where the profile along y crosses `level` on the way up after row `from`, in cells, linear in between.
double crossing(const std::vector<double>& profile, double level, int from, int direction) {
  for (int j = from;; j += direction) {
    const double a = profile[static_cast<std::size_t>(j)], b = profile[static_cast<std::size_t>(j + direction)];
    if ((a < level) != (b < level)) return j + 0.5 + direction * (level - a) / (b - a);
  }
}
std::vector<double> profile_along(const Bed& bed) {
  std::vector<double> p;
  for (int j = 0; j < bed.grid.ny; ++j) p.push_back(bed.mass[0][static_cast<std::size_t>(j * bed.grid.nx + bed.grid.nx / 2)]);
  return p;
}
}  // namespace

TEST(Operators, MS1_MassIsKeptByEachStageAndTheChain) {
  Bed bed = random_bed(37, 64, 4, 3, kPitch, 31);
  const Bed start = bed;
  for (const Operator& op : random_chain()) {
    bed = apply(op, bed, kSpeed, 0.013, 2);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(bed.powder_mass_kg(k) / start.powder_mass_kg(k), 1, 1e-12);  // fp64 limit of MS1
  }
}

// Doubly stochastic kernels leave a uniform bed alone. Limit of MS2: 1e-5; rounding is 1e-14.
TEST(Operators, MS2_UniformStaysUniform) {
  Bed bed = make_bed({37, 64, 4, kPitch, 0}, {"a", "b"});
  std::fill(bed.mass[0].begin(), bed.mass[0].end(), 6.0);
  for (const Operator& op : random_chain()) bed = apply(op, bed, kSpeed, 0, 1);
  for (double m : bed.mass[0]) ASSERT_NEAR(m, 6.0, 1e-12);
  for (double m : bed.mass[1]) ASSERT_EQ(m, 0.0);
}

TEST(Operators, MS3_ShiftEquivarianceAndIdentity) {
  const Bed bed = random_bed(30, 48, 3, 2, kPitch, 32);
  // K = delta is the identity, exact to rounding.
  EXPECT_LE(largest_difference(apply(identity_operator(3), bed, kSpeed, 0, 1), bed), 1e-14);
  EXPECT_LE(largest_difference(apply(identity_operator(1), bed, kSpeed, 0, 1), bed), 1e-14);

  const Operator op = random_operator(3, 5, 5, 10e-3, 1e-3, 24);
  const auto shifted = [](const Bed& b, int dx, int dy) {
    Bed out = b;
    for (auto& m : out.mass) std::fill(m.begin(), m.end(), 0.0);
    for (std::size_t k = 0; k < b.mass.size(); ++k)
      for (int row = 0; row < b.grid.nz * b.grid.ny; ++row) {
        const int z = row / b.grid.ny, y = (row % b.grid.ny + dy) % b.grid.ny;
        for (int x = 0; x + dx < b.grid.nx; ++x)
          out.mass[k][static_cast<std::size_t>((z * b.grid.ny + y) * b.grid.nx + x + dx)] = b.mass[k][static_cast<std::size_t>(row * b.grid.nx + x)];
      }
    return out;
  };
  EXPECT_LE(largest_difference(apply(op, shifted(bed, 0, 11), kSpeed, 0, 1), shifted(apply(op, bed, kSpeed, 0, 1), 0, 11)), 1e-13);
  // Across the belt only away from the walls: a bed that is empty within the kernel's reach of both.
  Bed inner = bed;
  for (auto& m : inner.mass)
    for (std::size_t i = 0; i < m.size(); ++i)
      if (i % 30 < 4 || i % 30 >= 18) m[i] = 0;
  EXPECT_LE(largest_difference(apply(op, shifted(inner, 6, 0), kSpeed, 0, 1), shifted(apply(op, inner, kSpeed, 0, 1), 6, 0)), 1e-13);
}

// Grids that match the bed: no resampling in between, so associativity holds to rounding (limit of MS4: 1e-6).
TEST(Operators, MS4_CompositionEqualsApplyingOneAfterTheOther) {
  const Bed bed = random_bed(40, 60, 3, 2, kPitch, 33);
  Operator first = random_operator(3, 5, 7, 10e-3, 1e-3, 25), second = random_operator(3, 4, 3, 10e-3, 1e-3, 26);
  second.theta0_s += 5e-3;  // 4 samples: put their centres on bed cells
  first.reference_delay_s = 0.07;
  second.reference_delay_s = 0.11;
  const Operator both = compose(second, first);
  EXPECT_LE(largest_difference(apply(both, bed, kSpeed, 0.02, 1), apply(second, apply(first, bed, kSpeed, 0.01, 1), kSpeed, 0.01, 1)), 1e-13);
  // With a one-layer operator on either side, which acts on each layer alike.
  const Operator plain = random_operator(1, 3, 3, 10e-3, 1e-3, 27);
  EXPECT_LE(largest_difference(apply(compose(plain, first), bed, kSpeed, 0, 1), apply(plain, apply(first, bed, kSpeed, 0, 1), kSpeed, 0, 1)), 1e-13);
  EXPECT_LE(largest_difference(apply(compose(first, plain), bed, kSpeed, 0, 1), apply(first, apply(plain, bed, kSpeed, 0, 1), kSpeed, 0, 1)), 1e-13);
  EXPECT_LE(largest_difference(apply(compose(first, identity_operator(3)), bed, kSpeed, 0, 1), apply(first, bed, kSpeed, 0, 1)), 1e-13);
}

// Any cell-internal offset of both kernels: composition on the kernel grid and one after the other on the bed agree within the resampling error,
// which is zero in mass and mean and, for kernels this wide, in variance; what is left is shape, of order (h / sigma)^4.
TEST(Operators, MS4_AssociativeAtFractionalDelaysUpToShape) {
  Bed bed = make_bed({8, 120, 1, kPitch, 0}, {"vein"});
  for (int y = 40; y < 70; ++y)
    for (int x = 0; x < 8; ++x) bed.mass[0][static_cast<std::size_t>(y * 8 + x)] = 1;
  Operator g = gaussian_operator(0.04, 0, 0.01, 1e-3);
  g.reference_delay_s = 0.0337;
  EXPECT_LE(largest_difference(apply(compose(g, g), bed, kSpeed, 0, 1), apply(g, apply(g, bed, kSpeed, 0, 1), kSpeed, 0, 1)), 1e-3);
}

// A 12 mm vein through a 2.5 mm blur at a delay that fits no grid, at 2, 1 and 0.5 mm. Width at half height and edge position.
TEST(Operators, MS5_GridRefinementConverges) {
  std::vector<double> width_mm, edge_mm;
  for (double pitch : {2e-3, 1e-3, 0.5e-3}) {
    const int ny = static_cast<int>(std::lround(0.24 / pitch));
    Bed bed = make_bed({4, ny, 1, pitch, 0}, {"vein"});
    for (int j = 0; j < ny; ++j)  // exact cell averages of the vein [100.3, 112.3) mm
      for (int x = 0; x < 4; ++x)
        bed.mass[0][static_cast<std::size_t>(j * 4 + x)] = std::max(0.0, std::min(0.1123, (j + 1) * pitch) - std::max(0.1003, j * pitch)) / pitch;
    Operator g = gaussian_operator(0.025, 0, 0.001, 1e-3);
    g.reference_delay_s = 0.1377;
    const auto profile = profile_along(apply(g, bed, kSpeed, 0, 1));
    const int peak = static_cast<int>(std::max_element(profile.begin(), profile.end()) - profile.begin());
    const double low = crossing(profile, 0.5, peak, -1) * pitch * 1e3, high = crossing(profile, 0.5, peak, 1) * pitch * 1e3;
    width_mm.push_back(high - low);
    edge_mm.push_back(low);
  }
  // MS5: the change halves each time and is < 0.2 mm from 1 to 0.5 mm.
  for (const auto& figure : {width_mm, edge_mm}) {
    const double coarse = std::abs(figure[1] - figure[0]), fine = std::abs(figure[2] - figure[1]);
    EXPECT_LE(fine, std::max(0.5 * coarse, 1e-3)) << coarse;  // below a micrometre there is nothing left to halve
    EXPECT_LE(fine, 0.2);
  }
  EXPECT_NEAR(width_mm[2], 12, 0.02);            // a symmetric blur leaves the half-height width (the opposite edge is 4.8 sigma away)
  EXPECT_NEAR(edge_mm[2], 100.3 - 13.77, 0.02);  // and moves the edge by v * delay
}

// A half-plane through three Gaussian kernels at fractional delays: 10-90 % width of the edge = 2.563 sqrt(sum sigma^2) within 1 %.
TEST(Operators, MS6_WidthsAddInQuadrature) {
  const double pitch = 0.5e-3;
  Bed bed = make_bed({4, 600, 1, pitch, 0}, {"vein"});
  for (int j = 150; j < 450; ++j)
    for (int x = 0; x < 4; ++x) bed.mass[0][static_cast<std::size_t>(j * 4 + x)] = 1;
  double variance = 0;
  for (double sigma_mm : {2.0, 3.0, 1.5}) {
    Operator g = gaussian_operator(sigma_mm * 1e-3 / kSpeed, 0, 0.0031, 1e-3);
    g.reference_delay_s = 0.0123 * sigma_mm;
    bed = apply(g, bed, kSpeed, 0, 1);
    variance += sigma_mm * sigma_mm;
  }
  const auto profile = profile_along(bed);
  const double width_mm = (crossing(profile, 0.9, 250, -1) - crossing(profile, 0.1, 250, -1)) * pitch * 1e3;
  EXPECT_NEAR(width_mm / (2.563 * std::sqrt(variance)), 1, 0.01);
}
