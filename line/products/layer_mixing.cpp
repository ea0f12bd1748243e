#include "line/products/layer_mixing.h"

#define VENATO_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))

namespace venato::line {
namespace {
constexpr std::size_t kB = 8;
}

VENATO_CLONES void add_products(int n, ConstSpectrum packed, ConstSpectrum in, Spectrum out1, Spectrum out2) {
  const std::size_t size = static_cast<std::size_t>(n);
  for (std::size_t k = 0; k < size; ++k) {
    const std::size_t at = k * kB, mirror = (k == 0 ? 0 : size - k) * kB;
    const double* __restrict gr = packed.re + at, * __restrict gi = packed.im + at, * __restrict mr = packed.re + mirror, * __restrict mi = packed.im + mirror;
    const double* __restrict zr = in.re + at, * __restrict zi = in.im + at;
    double* __restrict ar = out1.re + at, * __restrict ai = out1.im + at;
    for (std::size_t b = 0; b < kB; ++b) {
      const double hr = 0.5 * (gr[b] + mr[b]), hi = 0.5 * (gi[b] - mi[b]);
      ar[b] += hr * zr[b] - hi * zi[b];
      ai[b] += hr * zi[b] + hi * zr[b];
    }
    if (!out2.re) continue;
    double* __restrict br = out2.re + at, * __restrict bi = out2.im + at;
    for (std::size_t b = 0; b < kB; ++b) {
      const double hr = 0.5 * (gi[b] + mi[b]), hi = 0.5 * (mr[b] - gr[b]);
      br[b] += hr * zr[b] - hi * zi[b];
      bi[b] += hr * zi[b] + hi * zr[b];
    }
  }
}

VENATO_CLONES void multiply(int n, ConstSpectrum kernel, Spectrum inout) {
  const std::size_t size = static_cast<std::size_t>(n) * kB;
  const double* __restrict hr = kernel.re, * __restrict hi = kernel.im;
  double* __restrict zr = inout.re, * __restrict zi = inout.im;
  for (std::size_t i = 0; i < size; ++i) {
    const double re = hr[i] * zr[i] - hi[i] * zi[i];
    zi[i] = hr[i] * zi[i] + hi[i] * zr[i];
    zr[i] = re;
  }
}

VENATO_CLONES void cosine_sum(int n_e, const double* weight, const double* cosine, double* row) {
  for (int e = 0; e < n_e; ++e) {
    const double w = weight[e];
    const double* __restrict c = cosine + static_cast<std::size_t>(e) * kB;
    double* __restrict out = row;
    for (std::size_t b = 0; b < kB; ++b) out[b] += w * c[b];
  }
}
}  // namespace venato::line
