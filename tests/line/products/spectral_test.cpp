#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "base/rng.h"
#include "line/products/spectral/mirror_dct.h"

using namespace venato;
using namespace venato::line;
constexpr int kB = BatchFft::kBatch;

namespace {
std::vector<double> noise(std::size_t n, std::uint64_t entity) {
  Rng rng(7, stream_id("tests/line/products/spectral"), entity);
  std::vector<double> v(n);
  for (double& x : v) x = rng.uniform() - 0.5;
  return v;
}
}  // namespace

// Reference: the defining sum. Tolerance: 1e-13 per sqrt(n) is 100 x rounding; a wrong twiddle gives O(1). 53, 106 and 1613 go through the chirp.
TEST(BatchFft, MatchesTheDefiningSumForAnyLength) {
  for (int n : {1, 2, 3, 4, 5, 6, 7, 8, 12, 15, 16, 37, 49, 53, 60, 106, 210, 256, 360, 1613}) {
    const auto size = static_cast<std::size_t>(n) * kB;
    std::vector<double> re = noise(size, 1), im = noise(size, 2), xr = re, xi = im;
    const BatchFft fft(n);
    std::vector<double> work(fft.work_size());
    fft.forward(re.data(), im.data(), work.data());
    for (int k : {0, 1, n / 2, n - 1})
      for (int b = 0; b < kB; ++b) {
        std::complex<double> sum = 0;
        for (long long j = 0; j < n; ++j)
          sum += std::complex<double>(xr[static_cast<std::size_t>(j) * kB + b], xi[static_cast<std::size_t>(j) * kB + b]) *
                 std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(j * (k % n) % n) / n);
        const auto at = static_cast<std::size_t>(k % n) * kB + static_cast<std::size_t>(b);
        EXPECT_NEAR(re[at], sum.real(), 1e-13 * std::sqrt(n)) << n << " " << k;
        EXPECT_NEAR(im[at], sum.imag(), 1e-13 * std::sqrt(n)) << n << " " << k;
      }
    fft.inverse(re.data(), im.data(), work.data());
    for (std::size_t i = 0; i < size; ++i) {
      ASSERT_NEAR(re[i] / n, xr[i], 1e-13) << n;
      ASSERT_NEAR(im[i] / n, xi[i], 1e-13) << n;
    }
  }
}

TEST(MirrorDct, MatchesTheDefiningSumAndComesBack) {
  for (int n : {1, 2, 3, 4, 5, 8, 9, 30, 31, 53, 100}) {
    const auto size = static_cast<std::size_t>(n) * kB;
    std::vector<double> re = noise(size, 3), im = noise(size, 4), xr = re, xi = im;
    const MirrorDct dct(n);
    std::vector<double> work(dct.work_size());
    dct.forward(re.data(), im.data(), work.data());
    for (int k = 0; k < n; ++k) {
      double a = 0, b = 0;
      for (int i = 0; i < n; ++i) {
        const double c = std::cos(std::numbers::pi * k * (i + 0.5) / n);
        a += xr[static_cast<std::size_t>(i) * kB + 5] * c;
        b += xi[static_cast<std::size_t>(i) * kB + 2] * c;
      }
      EXPECT_NEAR(re[static_cast<std::size_t>(k) * kB + 5], a, 1e-13 * n) << n << " " << k;
      EXPECT_NEAR(im[static_cast<std::size_t>(k) * kB + 2], b, 1e-13 * n) << n << " " << k;
    }
    dct.inverse(re.data(), im.data(), work.data());
    for (std::size_t i = 0; i < size; ++i) {
      ASSERT_NEAR(re[i], xr[i], 1e-13) << n;
      ASSERT_NEAR(im[i], xi[i], 1e-13) << n;
    }
  }
}

TEST(NextSmoothSize, HasOnlySmallFactors) {
  EXPECT_EQ(next_smooth_size(1), 1);
  EXPECT_EQ(next_smooth_size(7), 8);
  EXPECT_EQ(next_smooth_size(1801), 1875);  // 3 * 5^4
}
