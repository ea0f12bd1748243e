#include <gtest/gtest.h>

#include "base/error.h"
#include "line/products/kernel_on_bed.h"
#include "tests/line/products/random_operator.h"

using namespace venato;
using namespace venato::line;

namespace {
// The obvious code: every cell thrown through the kernel, mirrored at the walls one reflection at a time.
Bed apply_by_brute_force(const BedKernel& kernel, const Bed& bed) {
  Bed out = make_bed({bed.grid.nx, bed.grid.ny, kernel.nz_out, bed.grid.pitch_m, bed.grid.lead_m}, bed.powders);
  const int nx = bed.grid.nx, ny = bed.grid.ny;
  const auto fold = [&](int x) {
    while (x < 0 || x >= nx) x = x < 0 ? -1 - x : 2 * nx - 1 - x;
    return x;
  };
  for (std::size_t k = 0; k < bed.mass.size(); ++k)
    for (int zin = 0; zin < kernel.nz_in; ++zin)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
          const double m = bed.mass[k][static_cast<std::size_t>((zin * ny + y) * nx + x)];
          for (int zout = 0; zout < kernel.nz_out; ++zout)
            for (int r = 0; r < kernel.n_y; ++r)
              for (int e = 0; e < kernel.n_x; ++e) {
                const double w = kernel.pair(zin, zout)[r * kernel.n_x + e];
                const int to_y = (((y + kernel.y_offset + r) % ny) + ny) % ny;
                for (int side = e == 0 ? 1 : -1; side <= 1; side += 2)
                  out.mass[k][static_cast<std::size_t>((zout * ny + to_y) * nx + fold(x + side * e))] += w * m;
              }
        }
  return out;
}
double inner(const Bed& a, const Bed& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.mass.size(); ++k)
    for (std::size_t i = 0; i < a.mass[k].size(); ++i) sum += a.mass[k][i] * b.mass[k][i];
  return sum;
}
}  // namespace

// reference: fast vs obvious. Rounding of transforms of ~50 points with O(1) data is 1e-15; one powder and three powders exercise the odd pairing, 53
// x 22 the chirp, 5 x 7 a kernel wider than the bed in both directions.
TEST(Apply, EqualsBruteForce) {
  struct Size {
    int nx, ny, nz;
    std::size_t powders;
  };
  for (const Size s : {Size{30, 24, 3, 2}, Size{53, 22, 2, 3}, Size{17, 23, 4, 1}, Size{5, 7, 1, 2}}) {
    const Bed bed = random_bed(s.nx, s.ny, s.nz, s.powders, 1e-3, 11);
    const Operator op = random_operator(s.nz, 9, 13, 7e-3, 0.8e-3, 5);
    const BedKernel kernel = kernel_on_bed(op, op.weight, 0.05, 1e-3, 0.13, 0);
    Operator delayed = op;
    delayed.reference_delay_s = 0.05;
    EXPECT_LE(largest_difference(apply(delayed, bed, 0.13, 0, 2), apply_by_brute_force(kernel, bed)), 1e-13);
  }
}

// The adjoint by its definition. 1e-10 relative is the requirement (multiscale.md ID2); rounding gives 1e-15.
TEST(ApplyTransposed, IsTheAdjoint) {
  for (int nx : {20, 53}) {
    const Bed a = random_bed(nx, 46, 3, 2, 1e-3, 1), b = random_bed(nx, 46, 3, 2, 1e-3, 2);
    Operator op = random_operator(3, 8, 7, 9e-3, 1.1e-3, 6);
    op.reference_delay_s = 0.2;
    const double forward = inner(apply(op, a, 0.15, 0.17, 1), b), backward = inner(a, apply_transposed(op, b, 0.15, 0.17, 1));
    EXPECT_NEAR(forward / backward, 1, 1e-12);
    // A control: the forward operator is not its own adjoint here, so the test can fail.
    EXPECT_GT(std::abs(inner(a, apply(op, b, 0.15, 0.17, 1)) / forward - 1), 1e-7);
  }
}

// The belt runs to +y. Powder held back by the stage lands on belt that passes later, that is further upstream: smaller y.
TEST(Apply, DelayMovesPowderUpstream) {
  Bed bed = make_bed({4, 100, 1, 1e-3, 0}, {"vein"});
  bed.mass[0][static_cast<std::size_t>(50 * 4 + 2)] = 1;
  Operator op = identity_operator(1);
  op.reference_delay_s = 0.1;
  const auto row_of = [](const Bed& b) {
    double mean = 0;
    for (std::size_t i = 0; i < b.mass[0].size(); ++i) mean += b.mass[0][i] * static_cast<double>(i / 4);
    return mean;
  };
  EXPECT_NEAR(row_of(apply(op, bed, 0.2, 0.0, 1)), 30, 1e-12);   // 0.2 m/s * 0.1 s = 20 mm later
  EXPECT_NEAR(row_of(apply(op, bed, 0.2, 0.1, 1)), 50, 1e-12);   // the controller takes it all off
  EXPECT_NEAR(row_of(apply(op, bed, 0.2, 0.15, 1)), 60, 1e-12);  // and too much
  op.theta0_s += 0.05;
  op.reference_delay_s = 0;
  EXPECT_NEAR(row_of(apply(op, bed, 0.2, 0.0, 1)), 40, 1e-12);
}

TEST(Apply, SameBytesForAnyNumberOfThreads) {
  const Bed bed = random_bed(41, 90, 3, 3, 1e-3, 3);
  const Operator op = random_operator(3, 7, 5, 8e-3, 1e-3, 8);
  const Bed one = apply(op, bed, 0.1, 0, 1);
  for (int threads : {2, 4, 7}) EXPECT_EQ(one.mass, apply(op, bed, 0.1, 0, threads).mass);
}

TEST(Apply, EmptyCellsStayEmptyAndNothingIsNegative) {
  Bed bed = make_bed({60, 200, 2, 1e-3, 0}, {"body", "vein"});
  std::fill(bed.mass[0].begin(), bed.mass[0].end(), 12.0);
  bed.mass[1][static_cast<std::size_t>(100 * 60 + 30)] = 1.0;
  const Bed out = apply(random_operator(2, 5, 5, 10e-3, 1e-3, 9), bed, 0.1, 0, 2);
  std::size_t empty = 0;
  for (double m : out.mass[1]) {
    EXPECT_GE(m, 0);
    empty += m == 0;
  }
  EXPECT_EQ(empty, 2u * 60 * 200 - 2u * 5 * 5);
}

TEST(Apply, UsesTheReplicateAskedFor) {
  const Bed bed = random_bed(16, 32, 2, 1, 1e-3, 4);
  Operator op = random_operator(2, 3, 3, 10e-3, 1e-3, 10), other = random_operator(2, 3, 3, 10e-3, 1e-3, 12);
  other.reference_delay_s = 0.03;
  op.replicates = {op.weight, other.weight};
  op.replicate_reference_delay_s = {0, 0.03};
  EXPECT_EQ(apply(op, bed, 0.1, 0, 1, 1).mass, apply(other, bed, 0.1, 0, 1).mass);
  EXPECT_EQ(apply(op, bed, 0.1, 0, 1, 0).mass, apply(op, bed, 0.1, 0, 1).mass);
  EXPECT_THROW(apply(op, bed, 0.1, 0, 1, 2), UsageError);
}

TEST(Apply, RefusesKernelsThatWouldLoseMass) {
  const Bed bed = random_bed(16, 32, 2, 1, 1e-3, 4);
  Operator leaky = random_operator(2, 3, 3, 10e-3, 1e-3, 10);
  leaky.weight[0] += 1e-3;
  leaky.weight[2] += 1e-3;
  EXPECT_THROW(apply(leaky, bed, 0.1, 0, 1), UsageError);
  Operator skew = random_operator(2, 3, 3, 10e-3, 1e-3, 10);
  std::swap(skew.weight[0], skew.weight[1]);
  EXPECT_THROW(apply(skew, bed, 0.1, 0, 1), UsageError);
  Operator layers = random_operator(3, 3, 3, 10e-3, 1e-3, 10);
  EXPECT_THROW(apply(layers, bed, 0.1, 0, 1), UsageError);
  Operator broken = random_operator(2, 3, 3, 10e-3, 1e-3, 10);
  broken.weight[1] = std::nan("");
  EXPECT_THROW(apply(broken, bed, 0.1, 0, 1), UsageError);
}
