#include "line/products/spectral/mirror_dct.h"

#include <cmath>
#include <cstring>
#include <numbers>

namespace venato::line {
namespace {
constexpr std::size_t kB = BatchFft::kBatch;

// v = even samples forwards, odd samples backwards.
std::size_t source_of(std::size_t j, std::size_t n) { return j < (n + 1) / 2 ? 2 * j : 2 * (n - 1 - j) + 1; }
}  // namespace

MirrorDct::MirrorDct(int n) : fft_(n), shift_(2 * static_cast<std::size_t>(n)) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
    const double angle = -std::numbers::pi * static_cast<double>(k) / (2.0 * n);
    shift_[2 * k] = std::cos(angle);
    shift_[2 * k + 1] = std::sin(angle);
  }
}

void MirrorDct::forward(double* re, double* im, double* work) const {
  const std::size_t n = static_cast<std::size_t>(size());
  double *vr = work, *vi = work + n * kB;
  for (std::size_t j = 0; j < n; ++j) {
    std::memcpy(vr + j * kB, re + source_of(j, n) * kB, kB * sizeof(double));
    std::memcpy(vi + j * kB, im + source_of(j, n) * kB, kB * sizeof(double));
  }
  fft_.forward(vr, vi, work + 2 * n * kB);
  for (std::size_t k = 0; k <= n / 2; ++k) {
    const std::size_t mirror = (n - k) % n;
    const double c = shift_[2 * k], s = shift_[2 * k + 1];
    for (std::size_t b = 0; b < kB; ++b) {
      const double pr = vr[k * kB + b], pi = vi[k * kB + b], qr = vr[mirror * kB + b], qi = vi[mirror * kB + b];
      // Spectra of the two real signals, halves of P +- conj(Q).
      const double ar = 0.5 * (pr + qr), ai = 0.5 * (pi - qi), br = 0.5 * (pi + qi), bi = 0.5 * (qr - pr);
      re[k * kB + b] = c * ar - s * ai;
      im[k * kB + b] = c * br - s * bi;
      if (mirror != k) {
        re[mirror * kB + b] = -(c * ai + s * ar);
        im[mirror * kB + b] = -(c * bi + s * br);
      }
    }
  }
}

void MirrorDct::inverse(double* re, double* im, double* work) const {
  const std::size_t n = static_cast<std::size_t>(size());
  double *vr = work, *vi = work + n * kB;
  const double scale = 1.0 / static_cast<double>(n);
  for (std::size_t k = 0; k <= n / 2; ++k) {
    const std::size_t mirror = (n - k) % n;
    const double c = shift_[2 * k] * scale, s = shift_[2 * k + 1] * scale;
    for (std::size_t b = 0; b < kB; ++b) {
      const double xa = re[k * kB + b], xb = im[k * kB + b];
      const double ya = k == 0 ? 0.0 : -re[mirror * kB + b], yb = k == 0 ? 0.0 : -im[mirror * kB + b];
      const double ar = c * xa + s * ya, ai = c * ya - s * xa, br = c * xb + s * yb, bi = c * yb - s * xb;  // conj(shift) * (x + i y)
      vr[k * kB + b] = ar - bi;
      vi[k * kB + b] = ai + br;
      if (mirror != k) {
        vr[mirror * kB + b] = ar + bi;
        vi[mirror * kB + b] = br - ai;
      }
    }
  }
  fft_.inverse(vr, vi, work + 2 * n * kB);
  for (std::size_t j = 0; j < n; ++j) {
    std::memcpy(re + source_of(j, n) * kB, vr + j * kB, kB * sizeof(double));
    std::memcpy(im + source_of(j, n) * kB, vi + j * kB, kB * sizeof(double));
  }
}
}  // namespace venato::line
