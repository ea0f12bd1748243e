#include "line/products/kernel_on_bed.h"

#include <gtest/gtest.h>

#include "tests/line/products/random_operator.h"

using namespace venato;
using namespace venato::line;

namespace {
struct Moments {
  double mass = 0, mean_y = 0, variance_y = 0, variance_x = 0;
};
Moments moments(const BedKernel& k, int zin, int zout) {
  Moments m;
  double second_y = 0;
  for (int r = 0; r < k.n_y; ++r)
    for (int e = 0; e < k.n_x; ++e) {
      const double w = k.pair(zin, zout)[r * k.n_x + e] * (e == 0 ? 1 : 2), y = k.y_offset + r;
      EXPECT_GE(w, 0);
      m.mass += w;
      m.mean_y += w * y;
      second_y += w * y * y;
      m.variance_x += w * e * e;
    }
  m.mean_y /= m.mass;
  m.variance_y = second_y / m.mass - m.mean_y * m.mean_y;
  m.variance_x /= m.mass;
  return m;
}
}  // namespace

// A wide kernel at any offset inside the cell, sampled finer, equal and coarser than the bed: mass, mean and variance are those of the samples, to
// rounding.
TEST(KernelOnBed, KeepsMassMeanAndVarianceOfWideKernels) {
  for (double step_cells : {0.37, 1.0, 1.9})
    for (double delay_cells : {0.0, 0.25, 0.5, 0.81, 7.3}) {
      const double pitch = 1e-3, v = 0.15, dtheta = step_cells * pitch / v;
      const Operator op = gaussian_operator(4 * pitch / v, 3 * pitch, dtheta, step_cells * pitch);
      double variance_t = 0, variance_e = 0;
      for (int t = 0; t < op.n_theta; ++t)
        for (int e = 0; e < op.n_eta; ++e) {
          const double a = (t - op.n_theta / 2) * step_cells, b = (e - op.n_eta / 2) * step_cells, w = op.weight[op.index(0, 0, t, e)];
          variance_t += w * a * a;
          variance_e += w * b * b;
        }
      const Moments m = moments(kernel_on_bed(op, op.weight, delay_cells * pitch / v, pitch, v, 0), 0, 0);
      EXPECT_NEAR(m.mass, 1, 1e-13);
      EXPECT_NEAR(m.mean_y, -delay_cells, 1e-11);
      EXPECT_NEAR(m.variance_y, variance_t, 1e-10);
      EXPECT_NEAR(m.variance_x, variance_e, 1e-10);
    }
}

// A point cannot move by a fraction of a cell without widening; the price is f (1 - f), no more.
TEST(KernelOnBed, PointKernelWidensByTheKnownMinimum) {
  const Operator op = identity_operator(1);
  for (double f : {0.0, 0.1, 0.5, 0.9}) {
    const Moments m = moments(kernel_on_bed(op, op.weight, f * 1e-3 / 0.1, 1e-3, 0.1, 0), 0, 0);
    EXPECT_NEAR(m.mean_y, -f, 1e-12);
    EXPECT_NEAR(m.variance_y, f * (1 - f), 1e-12);
  }
}

// Samples 3 cells apart must not leave two of three rows empty.
TEST(KernelOnBed, CoarseSamplesMakeNoComb) {
  const Operator op = gaussian_operator(0.06, 0, 0.02, 1e-3);  // 3 mm steps at 0.15 m/s
  const BedKernel k = kernel_on_bed(op, op.weight, 0, 1e-3, 0.15, 0);
  for (int r = k.n_y / 2 - 9; r < k.n_y / 2 + 8; ++r) {
    const double a = k.pair(0, 0)[r * k.n_x], b = k.pair(0, 0)[(r + 1) * k.n_x];
    EXPECT_NEAR(b / a, 1, 0.35) << r;  // the steepest true ratio within one sigma is exp(9.5 / 81) = 1.12; steps of the samples add to it
  }
}
