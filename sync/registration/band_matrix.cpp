#include "sync/registration/band_matrix.h"
#include <algorithm>
#include <cmath>
#include "base/error.h"
#include "base/expects.h"
namespace venato::sync {
namespace {
constexpr int kLanes = 8;  // partial sums; fixed, so that SIMD width does not change a result

using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
const Four& load(const double* p) {  // a reference: vectors by value would depend on the instruction set
  return *reinterpret_cast<const Four*>(p);
}

__attribute__((target_clones("avx2", "default"))) double dot(const double* a, const double* b, int n) {
  double lane[kLanes] = {};
  int k = 0;
  for (; k + kLanes <= n; k += kLanes)
    for (int l = 0; l < kLanes; ++l) lane[l] += a[k + l] * b[k + l];
  double rest = 0;
  for (; k < n; ++k) rest += a[k] * b[k];
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7])) + rest;
}
/// out[r] = a_r . b, as dot().
__attribute__((target_clones("avx2", "default"))) void four_dots(const double* a0, const double* a1, const double* a2, const double* a3,
                                                                 const double* b, int n, double* out) {
  Four low[4] = {}, high[4] = {};
  const double* const a[4] = {a0, a1, a2, a3};
  int k = 0;
  for (; k + kLanes <= n; k += kLanes) {
    const Four bl = load(b + k), bh = load(b + k + 4);
    for (int r = 0; r < 4; ++r) {
      low[r] += load(a[r] + k) * bl;
      high[r] += load(a[r] + k + 4) * bh;
    }
  }
  for (int r = 0; r < 4; ++r) {
    double rest = 0;
    for (int l = k; l < n; ++l) rest += a[r][l] * b[l];
    const Four sum = low[r] + high[r];
    out[r] = (sum[0] + sum[2]) + (sum[1] + sum[3]) + rest;
  }
}
}  // namespace

BandMatrix::BandMatrix(int order, int half_band)
    : order_(order),
      half_band_(half_band),
      stride_(kPad + half_band + 1),
      data_(static_cast<std::size_t>(order) * static_cast<std::size_t>(stride_), 0.0) {
  VENATO_EXPECTS(order > 0 && half_band >= 0);
}

BandCholesky::BandCholesky(BandMatrix a) : l_(std::move(a)) {
  constexpr int kRows = BandMatrix::kPad + 1;
  for (int i = 0; i < l_.order(); i += kRows) {
    const int rows = std::min(kRows, l_.order() - i), first = std::max(0, i - l_.half_band());
    // Columns left of the four rows: one pass over row j serves all of them. The padding is 0 where a row's own band starts later.
    if (rows == kRows)
      for (int j = first; j < i; ++j) {
        const int from = std::max(first, j - l_.half_band());
        const double* const lj = l_.row(j);
        double sums[kRows];
        four_dots(l_.row(i) + from, l_.row(i + 1) + from, l_.row(i + 2) + from, l_.row(i + 3) + from, lj + from, j - from, sums);
        for (int r = 0; r < kRows; ++r)
          if (j >= i + r - l_.half_band()) l_.row(i + r)[j] = (l_.row(i + r)[j] - sums[r]) / lj[j];
      }
    for (int r = 0; r < rows; ++r) {
      double* const li = l_.row(i + r);
      const int start = std::max(0, i + r - l_.half_band());
      for (int j = rows == kRows ? std::max(i, start) : start; j <= i + r; ++j) {
        const int from = std::max(start, j - l_.half_band());
        const double* const lj = l_.row(j);
        const double rest = li[j] - dot(li + from, lj + from, j - from);
        if (j < i + r) {
          li[j] = rest / lj[j];
          continue;
        }
        if (!(rest > 0)) throw WorkError("registration: the spline's normal equations could not be factorised");
        li[j] = std::sqrt(rest);
      }
    }
  }
}

Eigen::VectorXd BandCholesky::solve(Eigen::VectorXd x) const {
  VENATO_EXPECTS(x.size() == l_.order());
  for (int i = 0; i < l_.order(); ++i) {
    const int first = std::max(0, i - l_.half_band());
    const double* const li = l_.row(i);
    x(i) = (x(i) - dot(li + first, x.data() + first, i - first)) / li[i];
  }
  for (int i = l_.order() - 1; i >= 0; --i) {
    const int first = std::max(0, i - l_.half_band());
    const double* const li = l_.row(i);
    x(i) /= li[i];
    for (int k = first; k < i; ++k) x(k) -= li[k] * x(i);
  }
  return x;
}

BandInverse::BandInverse(const BandCholesky& factor)
    : half_band_(factor.lower().half_band()),
      stride_(2 * half_band_ + 1),
      data_(static_cast<std::size_t>(factor.lower().order()) * static_cast<std::size_t>(stride_), 0.0) {
  const BandMatrix& l = factor.lower();
  std::vector<double> column(static_cast<std::size_t>(half_band_) + 1);
  for (int j = l.order() - 1; j >= 0; --j) {
    const int last = std::min(l.order() - 1, j + half_band_), n = last - j;
    const double diagonal = l.at(j, j);
    for (int k = 1; k <= n; ++k) column[static_cast<std::size_t>(k)] = l.at(j + k, j) / diagonal;
    // Z(i, j) = - sum_k l(k, j) Z(i, k) for i > j, then Z(j, j) = 1 / d - sum_k l(k, j) Z(k, j), with l of unit diagonal.
    for (int i = j + 1; i <= last; ++i) {
      const double z = -dot(column.data() + 1, row(i) + j + 1, n);
      row(i)[j] = z;
      row(j)[i] = z;
    }
    row(j)[j] = 1 / (diagonal * diagonal) - dot(column.data() + 1, row(j) + j + 1, n);
  }
}
}  // namespace venato::sync
