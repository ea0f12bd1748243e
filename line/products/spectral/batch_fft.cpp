#include "line/products/spectral/batch_fft.h"

#include <cmath>
#include <cstring>
#include <numbers>

#include "base/expects.h"
#include "line/products/spectral/fft_passes.h"

namespace venato::line {
namespace {
constexpr int kB = BatchFft::kBatch;
constexpr int kLargestDirectPrime = 50;  // above, the O(p) butterfly costs more than the two transforms of the chirp

std::vector<int> radices_of(int n) {
  std::vector<int> radices;
  while (n % 4 == 0) radices.push_back(4), n /= 4;
  for (int p = 2; n > 1; ++p)
    while (n % p == 0) radices.push_back(p), n /= p;
  return radices;
}

void unit_root(long long numerator, long long denominator, double* out) {  // exp(-2 pi i numerator / denominator)
  const double angle = -2 * std::numbers::pi * static_cast<double>(numerator % denominator) / static_cast<double>(denominator);
  out[0] = std::cos(angle);
  out[1] = std::sin(angle);
}
}  // namespace

int next_smooth_size(int n) {
  for (int candidate = n;; ++candidate) {
    int rest = candidate;
    for (int p : {2, 3, 5})
      while (rest % p == 0) rest /= p;
    if (rest == 1) return candidate;
  }
}

BatchFft::BatchFft(int n) : n_(n) {
  VENATO_EXPECTS(n >= 1);
  const std::vector<int> radices = radices_of(n);
  if (!radices.empty() && radices.back() > kLargestDirectPrime) {
    inner_.emplace_back(next_smooth_size(2 * n - 1));
    const int m = inner_[0].size();
    chirp_.resize(2 * static_cast<std::size_t>(n));
    for (long long j = 0; j < n; ++j) unit_root(j * j % (2LL * n), 2LL * n, &chirp_[2 * static_cast<std::size_t>(j)]);
    std::vector<double> re(static_cast<std::size_t>(m) * kB, 0.0), im = re, work(inner_[0].work_size());
    for (int j = 0; j < n; ++j)
      for (int at : {j, (m - j) % m}) {
        re[static_cast<std::size_t>(at) * kB] = chirp_[2 * static_cast<std::size_t>(j)];
        im[static_cast<std::size_t>(at) * kB] = -chirp_[2 * static_cast<std::size_t>(j) + 1];
      }
    inner_[0].forward(re.data(), im.data(), work.data());
    chirp_spectrum_.resize(2 * static_cast<std::size_t>(m));
    for (std::size_t k = 0; k < static_cast<std::size_t>(m); ++k) {
      chirp_spectrum_[2 * k] = re[k * kB] / m;
      chirp_spectrum_[2 * k + 1] = im[k * kB] / m;
    }
    return;
  }
  int rest = n, s = 1;
  for (int radix : radices) {
    Stage stage{radix, rest / radix, s, {}};
    stage.twiddle.resize(static_cast<std::size_t>(stage.m) * static_cast<std::size_t>(radix - 1) * 2);
    double* w = stage.twiddle.data();
    for (long long q = 0; q < stage.m; ++q)
      for (long long j = 1; j < radix; ++j, w += 2) unit_root(q * j, rest, w);
    rest = stage.m;
    s *= radix;
    stages_.push_back(std::move(stage));
  }
}

std::size_t BatchFft::work_size() const {
  const std::size_t own = 2 * static_cast<std::size_t>(n_) * kB;
  return inner_.empty() ? own : 2 * static_cast<std::size_t>(inner_[0].size()) * kB + inner_[0].work_size();
}

void BatchFft::forward(double* re, double* im, double* work) const { inner_.empty() ? smooth(re, im, work) : bluestein(re, im, work); }

void BatchFft::smooth(double* re, double* im, double* work) const {
  const std::size_t size = static_cast<std::size_t>(n_) * kB;
  double *xr = re, *xi = im, *yr = work, *yi = work + size;
  for (const Stage& stage : stages_) {
    const fft::PassShape shape{stage.m, static_cast<std::size_t>(stage.s) * kB, stage.twiddle.data()};
    switch (stage.radix) {
      case 2:
        fft::pass2(shape, xr, xi, yr, yi);
        break;
      case 3:
        fft::pass3(shape, xr, xi, yr, yi);
        break;
      case 4:
        fft::pass4(shape, xr, xi, yr, yi);
        break;
      case 5:
        fft::pass5(shape, xr, xi, yr, yi);
        break;
      default:
        fft::pass_any(stage.radix, shape, xr, xi, yr, yi);
    }
    std::swap(xr, yr);
    std::swap(xi, yi);
  }
  if (xr != re) {
    std::memcpy(re, xr, size * sizeof(double));
    std::memcpy(im, xi, size * sizeof(double));
  }
}

void BatchFft::bluestein(double* re, double* im, double* work) const {
  const std::size_t m = static_cast<std::size_t>(inner_[0].size()), n = static_cast<std::size_t>(n_);
  double *ar = work, *ai = work + m * kB, *inner_work = work + 2 * m * kB;
  const auto multiply = [](double xr, double xi, const double* w, double& yr, double& yi) {
    yr = xr * w[0] - xi * w[1];
    yi = xr * w[1] + xi * w[0];
  };
  std::memset(ar, 0, 2 * m * kB * sizeof(double));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t b = j * kB; b < (j + 1) * kB; ++b) multiply(re[b], im[b], &chirp_[2 * j], ar[b], ai[b]);
  inner_[0].forward(ar, ai, inner_work);
  for (std::size_t k = 0; k < m; ++k)
    for (std::size_t b = k * kB; b < (k + 1) * kB; ++b) multiply(ar[b], ai[b], &chirp_spectrum_[2 * k], ar[b], ai[b]);
  inner_[0].inverse(ar, ai, inner_work);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t b = j * kB; b < (j + 1) * kB; ++b) multiply(ar[b], ai[b], &chirp_[2 * j], re[b], im[b]);
}
}  // namespace venato::line
