#include "line/press_map/lateral_flow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/expects.h"
#include "line/products/spectral/mirror_dct.h"

namespace venato::line {
namespace {
constexpr std::size_t kB = BatchFft::kBatch;

// Eight rows (or columns) at a time through the lanes of a transform; groups share nothing.
template <class Index, class Transform>
void by_lanes(std::vector<double>& field, std::size_t lines, std::size_t length, std::size_t work_size, int threads, Index index,
              Transform transform) {
  const std::size_t groups = (lines + kB - 1) / kB;
#pragma omp parallel num_threads(threads)
  {
    std::vector<double> re(length * kB), im(length * kB), work(work_size);
#pragma omp for schedule(static)
    for (std::size_t group = 0; group < groups; ++group) {
      const std::size_t first = group * kB, count = std::min(kB, lines - first);
      std::fill(re.begin(), re.end(), 0.0);
      std::fill(im.begin(), im.end(), 0.0);
      for (std::size_t i = 0; i < length; ++i)
        for (std::size_t b = 0; b < count; ++b) re[i * kB + b] = field[index(first + b, i)];
      transform(first, re.data(), im.data(), work.data());
      for (std::size_t i = 0; i < length; ++i)
        for (std::size_t b = 0; b < count; ++b) field[index(first + b, i)] = re[i * kB + b];
    }
  }
}
// Eigenvalue of the negative second difference.
double stiffness(double turns, double pitch_m) { return (2 - 2 * std::cos(2 * std::numbers::pi * turns)) / (pitch_m * pitch_m); }
}  // namespace

std::vector<double> even_out(const std::vector<double>& excess, const BedGrid& grid, double length_m, int threads) {
  VENATO_EXPECTS(excess.size() == grid.columns() && length_m >= 0);
  std::vector<double> s = excess;
  if (length_m == 0) return s;
  const std::size_t nx = static_cast<std::size_t>(grid.nx), ny = static_cast<std::size_t>(grid.ny);
  const MirrorDct dct(grid.nx);
  const BatchFft fft(grid.ny);
  const auto row = [&](std::size_t y, std::size_t x) { return y * nx + x; };
  const auto column = [&](std::size_t x, std::size_t y) { return y * nx + x; };
  by_lanes(s, ny, nx, dct.work_size(), threads, row, [&](std::size_t, double* re, double* im, double* work) { dct.forward(re, im, work); });
  by_lanes(s, nx, ny, fft.work_size(), threads, column, [&](std::size_t first, double* re, double* im, double* work) {
    fft.forward(re, im, work);
    for (std::size_t l = 0; l < ny; ++l) {
      const double along = stiffness(static_cast<double>(l) / static_cast<double>(ny), grid.pitch_m);
      for (std::size_t b = 0; b < kB; ++b) {
        const double across = stiffness(static_cast<double>(std::min(first + b, nx - 1)) / (2.0 * static_cast<double>(nx)), grid.pitch_m);
        const double factor = 1 / ((1 + length_m * length_m * (across + along)) * static_cast<double>(ny));
        re[l * kB + b] *= factor;
        im[l * kB + b] *= factor;
      }
    }
    fft.inverse(re, im, work);
  });
  by_lanes(s, ny, nx, dct.work_size(), threads, row, [&](std::size_t, double* re, double* im, double* work) { dct.inverse(re, im, work); });
  return s;
}
}  // namespace venato::line
