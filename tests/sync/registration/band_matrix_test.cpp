#include "sync/registration/band_matrix.h"
#include <gtest/gtest.h>
#include <Eigen/LU>
#include <cmath>
#include "base/error.h"
namespace venato::sync {
namespace {

/// Diagonally dominant, so positive definite; every entry differs.
BandMatrix matrix(int order, int half_band) {
  BandMatrix a(order, half_band);
  for (int i = 0; i < order; ++i)
    for (int j = std::max(0, i - half_band); j <= i; ++j) a.at(i, j) = i == j ? 2.0 * half_band + 2 + std::cos(i) : std::sin(3.0 * i + 7.0 * j);
  return a;
}
Eigen::MatrixXd dense(const BandMatrix& a) {
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(a.order(), a.order());
  for (int i = 0; i < a.order(); ++i)
    for (int j = std::max(0, i - a.half_band()); j <= i; ++j) d(i, j) = d(j, i) = a.at(i, j);
  return d;
}

TEST(BandMatrix, SolvesAndInvertsLikeTheDenseMatrix) {
  // Orders that leave 0 to 3 rows over, bands shorter and longer than the groups of four rows, and a band as wide as the matrix.
  for (const auto& [order, half_band] :
       {std::pair(40, 9), std::pair(41, 2), std::pair(42, 23), std::pair(43, 0), std::pair(7, 20), std::pair(1, 0)}) {
    SCOPED_TRACE(std::to_string(order) + ", " + std::to_string(half_band));
    const BandMatrix a = matrix(order, half_band);
    const Eigen::MatrixXd d = dense(a), inverse = d.inverse();
    const BandCholesky factor(a);
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(order, -1, 2);
    EXPECT_LT((factor.solve(right) - inverse * right).norm(), 1e-12 * right.norm());
    const BandInverse z(factor);
    for (int i = 0; i < order; ++i)
      for (int j = std::max(0, i - half_band); j <= std::min(order - 1, i + half_band); ++j) EXPECT_NEAR(z.at(i, j), inverse(i, j), 1e-13);
  }
}
TEST(BandMatrix, RefusesAMatrixThatIsNotPositiveDefinite) {
  BandMatrix a = matrix(12, 3);
  a.at(7, 7) = -1;
  EXPECT_THROW(BandCholesky{a}, WorkError);
}
}  // namespace
}  // namespace venato::sync
