#include "sync/registration/posterior.h"
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>
#include "base/error.h"
#include "base/expects.h"
#include "sync/transform/bspline_basis.h"
namespace venato::sync {
namespace {
constexpr double kMm = 1e3;
/// Position of row `row` in column `column` of a compressed lower matrix; -1 if not stored.
Eigen::Index find(const Eigen::SparseMatrix<double>& m, int row, int column) {
  const int *begin = m.innerIndexPtr() + m.outerIndexPtr()[column], *end = m.innerIndexPtr() + m.outerIndexPtr()[column + 1];
  const int* at = std::lower_bound(begin, end, row);
  return at != end && *at == row ? at - m.innerIndexPtr() : -1;
}
}  // namespace

SelectedInverse::SelectedInverse(const Eigen::SparseMatrix<double>& lower) {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver(lower);
  if (solver.info() != Eigen::Success) throw WorkError("registration: the posterior covariance could not be factorised");
  const auto n = static_cast<int>(lower.rows());
  const Eigen::VectorXd d = solver.vectorD();
  Eigen::SparseMatrix<double> l = solver.matrixL();  // unit lower; Eigen keeps or drops the diagonal depending on the view, so both are handled
  l.makeCompressed();
  where_ = solver.permutationP().indices();
  // Pattern of L plus the diagonal.
  std::vector<Eigen::Triplet<double>> pattern;
  for (int j = 0; j < n; ++j) {
    pattern.emplace_back(j, j, 0.0);
    for (Eigen::SparseMatrix<double>::InnerIterator it(l, j); it; ++it)
      if (it.row() > j) pattern.emplace_back(static_cast<int>(it.row()), j, 0.0);
  }
  z_.resize(n, n);
  z_.setFromTriplets(pattern.begin(), pattern.end());
  z_.makeCompressed();
  double* z = z_.valuePtr();
  const int *rows = z_.innerIndexPtr(), *starts = z_.outerIndexPtr();
  std::vector<double> factor, sum;
  for (int j = n - 1; j >= 0; --j) {
    const int first = starts[j] + 1, last = starts[j + 1];  // below the diagonal
    const auto m = static_cast<std::size_t>(last - first);
    factor.assign(m, 0.0);
    sum.assign(m, 0.0);
    for (Eigen::SparseMatrix<double>::InnerIterator it(l, j); it; ++it)
      if (it.row() > j) factor[static_cast<std::size_t>(find(z_, static_cast<int>(it.row()), j) - first)] = it.value();
    // Z(r_a, j) = - sum_b L(r_b, j) Z(r_a, r_b); every (r_a, r_b) is in the pattern because column j fills it.
    for (std::size_t b = 0; b < m; ++b) {
      const int rb = rows[first + static_cast<int>(b)];
      Eigen::Index at = starts[rb];
      for (std::size_t a = b; a < m; ++a) {
        const int ra = rows[first + static_cast<int>(a)];
        while (rows[at] < ra) ++at;
        sum[a] -= factor[b] * z[at];
        if (a != b) sum[b] -= factor[a] * z[at];
      }
    }
    double diagonal = 1 / d(j);
    for (std::size_t a = 0; a < m; ++a) {
      z[first + static_cast<int>(a)] = sum[a];
      diagonal -= factor[a] * sum[a];
    }
    z[starts[j]] = diagonal;
  }
}

double SelectedInverse::at(int i, int j) const {
  const int a = where_(i), b = where_(j);
  const Eigen::Index k = find(z_, std::max(a, b), std::min(a, b));
  VENATO_EXPECTS(k >= 0);
  return z_.valuePtr()[k];
}

graphics::RasterF sigma_map(const BSplineField& u, const Eigen::SparseMatrix<double>& normal_lower, double unit_variance, double width_m,
                            double height_m, double pitch_m, int threads) {
  const SelectedInverse inverse(normal_lower);
  const int w = std::max(1, static_cast<int>(std::ceil(width_m / pitch_m - 1e-9))),
            h = std::max(1, static_cast<int>(std::ceil(height_m / pitch_m - 1e-9)));
  graphics::RasterF out(w, h, 1, pitch_m);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      const SplineCell x = spline_cell(((i + 0.5) * pitch_m - u.origin_m.x()) / u.spacing_m, u.nx),
                       y = spline_cell(((j + 0.5) * pitch_m - u.origin_m.y()) / u.spacing_m, u.ny);
      int node[16];
      double weight[16], variance = 0;
      for (int k = 0; k < 16; ++k) {
        node[k] = (y.first + k / 4) * u.nx + x.first + k % 4;
        weight[k] = y.weight[static_cast<std::size_t>(k / 4)] * x.weight[static_cast<std::size_t>(k % 4)];
      }
      for (int k = 0; k < 16; ++k)
        for (int l = 0; l <= k; ++l)
          variance +=
              (k == l ? 1 : 2) * weight[k] * weight[l] * (inverse.at(2 * node[k], 2 * node[l]) + inverse.at(2 * node[k] + 1, 2 * node[l] + 1));
      out.at(i, j) = static_cast<float>(std::sqrt(std::max(0.0, variance * unit_variance)) / kMm);
    }
  return out;
}
}  // namespace venato::sync
