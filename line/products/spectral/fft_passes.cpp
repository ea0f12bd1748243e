#include "line/products/spectral/fft_passes.h"

#include <cmath>
#include <numbers>

// -ffp-contract=off holds for every clone: the same operations in the same order, so the same bits on every CPU.
#define VENATO_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))

namespace venato::line::fft {
namespace {
inline void store(double* __restrict yr, double* __restrict yi, std::size_t l, double re, double im, double wr, double wi) {
  yr[l] = re * wr - im * wi;
  yi[l] = re * wi + im * wr;
}
}  // namespace

VENATO_CLONES void pass2(const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi) {
  const std::size_t run = shape.run, m = static_cast<std::size_t>(shape.m);
  for (std::size_t q = 0; q < m; ++q) {
    const double wr = shape.twiddle[2 * q], wi = shape.twiddle[2 * q + 1];
    const double* __restrict ar = xr + q * run, * __restrict ai = xi + q * run;
    const double* __restrict br = xr + (q + m) * run, * __restrict bi = xi + (q + m) * run;
    double* __restrict y0r = yr + 2 * q * run, * __restrict y0i = yi + 2 * q * run, * __restrict y1r = y0r + run, * __restrict y1i = y0i + run;
    for (std::size_t l = 0; l < run; ++l) {
      y0r[l] = ar[l] + br[l];
      y0i[l] = ai[l] + bi[l];
      store(y1r, y1i, l, ar[l] - br[l], ai[l] - bi[l], wr, wi);
    }
  }
}

VENATO_CLONES void pass3(const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi) {
  const std::size_t run = shape.run, m = static_cast<std::size_t>(shape.m);
  const double sin60 = std::numbers::sqrt3 / 2;
  for (std::size_t q = 0; q < m; ++q) {
    const double* w = shape.twiddle + 4 * q;
    const double* __restrict ar = xr + q * run, * __restrict ai = xi + q * run;
    const double* __restrict br = ar + m * run, * __restrict bi = ai + m * run, * __restrict cr = br + m * run, * __restrict ci = bi + m * run;
    double* __restrict y0r = yr + 3 * q * run, * __restrict y0i = yi + 3 * q * run;
    double* __restrict y1r = y0r + run, * __restrict y1i = y0i + run, * __restrict y2r = y1r + run, * __restrict y2i = y1i + run;
    for (std::size_t l = 0; l < run; ++l) {
      const double sr = br[l] + cr[l], si = bi[l] + ci[l], dr = sin60 * (br[l] - cr[l]), di = sin60 * (bi[l] - ci[l]);
      const double er = ar[l] - 0.5 * sr, ei = ai[l] - 0.5 * si;
      y0r[l] = ar[l] + sr;
      y0i[l] = ai[l] + si;
      store(y1r, y1i, l, er + di, ei - dr, w[0], w[1]);
      store(y2r, y2i, l, er - di, ei + dr, w[2], w[3]);
    }
  }
}

VENATO_CLONES void pass4(const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi) {
  const std::size_t run = shape.run, m = static_cast<std::size_t>(shape.m);
  for (std::size_t q = 0; q < m; ++q) {
    const double* w = shape.twiddle + 6 * q;
    const double* __restrict ar = xr + q * run, * __restrict ai = xi + q * run;
    const double* __restrict br = ar + m * run, * __restrict bi = ai + m * run, * __restrict cr = br + m * run, * __restrict ci = bi + m * run;
    const double* __restrict dr = cr + m * run, * __restrict di = ci + m * run;
    double* __restrict y0r = yr + 4 * q * run, * __restrict y0i = yi + 4 * q * run;
    double* __restrict y1r = y0r + run, * __restrict y1i = y0i + run, * __restrict y2r = y1r + run, * __restrict y2i = y1i + run;
    double* __restrict y3r = y2r + run, * __restrict y3i = y2i + run;
    for (std::size_t l = 0; l < run; ++l) {
      const double pr = ar[l] + cr[l], pi = ai[l] + ci[l], qr = ar[l] - cr[l], qi = ai[l] - ci[l];
      const double rr = br[l] + dr[l], ri = bi[l] + di[l], sr = br[l] - dr[l], si = bi[l] - di[l];
      y0r[l] = pr + rr;
      y0i[l] = pi + ri;
      store(y1r, y1i, l, qr + si, qi - sr, w[0], w[1]);
      store(y2r, y2i, l, pr - rr, pi - ri, w[2], w[3]);
      store(y3r, y3i, l, qr - si, qi + sr, w[4], w[5]);
    }
  }
}

VENATO_CLONES void pass5(const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi) {
  const std::size_t run = shape.run, m = static_cast<std::size_t>(shape.m);
  const double c1 = std::cos(2 * std::numbers::pi / 5), c2 = std::cos(4 * std::numbers::pi / 5);
  const double s1 = std::sin(2 * std::numbers::pi / 5), s2 = std::sin(4 * std::numbers::pi / 5);
  for (std::size_t q = 0; q < m; ++q) {
    const double* w = shape.twiddle + 8 * q;
    const double* __restrict ar = xr + q * run, * __restrict ai = xi + q * run;
    const double* __restrict br = ar + m * run, * __restrict bi = ai + m * run, * __restrict cr = br + m * run, * __restrict ci = bi + m * run;
    const double* __restrict dr = cr + m * run, * __restrict di = ci + m * run, * __restrict fr = dr + m * run, * __restrict fi = di + m * run;
    double* __restrict y0r = yr + 5 * q * run, * __restrict y0i = yi + 5 * q * run;
    double* __restrict y1r = y0r + run, * __restrict y1i = y0i + run, * __restrict y2r = y1r + run, * __restrict y2i = y1i + run;
    double* __restrict y3r = y2r + run, * __restrict y3i = y2i + run, * __restrict y4r = y3r + run, * __restrict y4i = y3i + run;
    for (std::size_t l = 0; l < run; ++l) {
      const double pr = br[l] + fr[l], pi = bi[l] + fi[l], ur = br[l] - fr[l], ui = bi[l] - fi[l];
      const double qr = cr[l] + dr[l], qi = ci[l] + di[l], vr = cr[l] - dr[l], vi = ci[l] - di[l];
      const double e1r = ar[l] + c1 * pr + c2 * qr, e1i = ai[l] + c1 * pi + c2 * qi, e2r = ar[l] + c2 * pr + c1 * qr, e2i = ai[l] + c2 * pi + c1 * qi;
      const double o1r = s1 * ur + s2 * vr, o1i = s1 * ui + s2 * vi, o2r = s2 * ur - s1 * vr, o2i = s2 * ui - s1 * vi;
      y0r[l] = ar[l] + pr + qr;
      y0i[l] = ai[l] + pi + qi;
      store(y1r, y1i, l, e1r + o1i, e1i - o1r, w[0], w[1]);
      store(y2r, y2i, l, e2r + o2i, e2i - o2r, w[2], w[3]);
      store(y3r, y3i, l, e2r - o2i, e2i + o2r, w[4], w[5]);
      store(y4r, y4i, l, e1r - o1i, e1i + o1r, w[6], w[7]);
    }
  }
}

VENATO_CLONES void pass_any(int radix, const PassShape& shape, const double* xr, const double* xi, double* yr, double* yi) {
  const std::size_t run = shape.run, m = static_cast<std::size_t>(shape.m), p = static_cast<std::size_t>(radix);
  for (std::size_t q = 0; q < m; ++q)
    for (std::size_t j = 0; j < p; ++j) {
      double* __restrict outr = yr + (p * q + j) * run, * __restrict outi = yi + (p * q + j) * run;
      const double tr = j == 0 ? 1.0 : shape.twiddle[2 * (q * (p - 1) + j - 1)], ti = j == 0 ? 0.0 : shape.twiddle[2 * (q * (p - 1) + j - 1) + 1];
      for (std::size_t k = 0; k < p; ++k) {
        const double angle = -2 * std::numbers::pi * static_cast<double>(j * k % p) / static_cast<double>(p);
        const double c = std::cos(angle), s = std::sin(angle), wr = c * tr - s * ti, wi = c * ti + s * tr;
        const double* __restrict ar = xr + (q + m * k) * run, * __restrict ai = xi + (q + m * k) * run;
        for (std::size_t l = 0; l < run; ++l) {
          const double re = ar[l] * wr - ai[l] * wi, im = ar[l] * wi + ai[l] * wr;
          outr[l] = k == 0 ? re : outr[l] + re;
          outi[l] = k == 0 ? im : outi[l] + im;
        }
      }
    }
}
}  // namespace venato::line::fft
