#include "graphics/seen/pixel_blur.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "graphics/raster/weighted_sum.h"
namespace venato::graphics {
namespace {
constexpr double kCut = 4;  // sd
constexpr double kCellsPerDeviation = 3;

std::vector<float> kernel(double sd_px) {
  const int r = std::max(1, static_cast<int>(std::ceil(kCut * sd_px)));
  std::vector<double> exact;
  double sum = 0;
  for (int k = -r; k <= r; ++k) {
    exact.push_back(std::erf((k + 0.5) / (M_SQRT2 * sd_px)) - std::erf((k - 0.5) / (M_SQRT2 * sd_px)));
    sum += exact.back();
  }
  std::vector<float> out;
  for (const double v : exact) out.push_back(static_cast<float>(v / sum));
  return out;
}

/// Cells of cell x cell pixels averaged, `pad` more cells than the image needs on every side.
struct Cells {
  int width = 0, height = 0, cell = 1, pad = 0;  ///< in cells, with the padding
  std::vector<float> data;
};
Cells averaged(const RasterF& image, int cell, int pad, int threads) {
  Cells out;
  out.cell = cell, out.pad = pad;
  out.width = (image.width + cell - 1) / cell + 2 * pad, out.height = (image.height + cell - 1) / cell + 2 * pad;
  out.data.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
#pragma omp parallel num_threads(threads)
  {
    std::vector<float> column(static_cast<std::size_t>(image.width));  // sums down the rows of a cell
#pragma omp for schedule(static)
    for (int j = 0; j < out.height; ++j) {
      std::fill(column.begin(), column.end(), 0.0f);
      for (int k = 0; k < cell; ++k) {
        const float* row = &image.at(0, std::clamp((j - pad) * cell + k, 0, image.height - 1));
        for (int i = 0; i < image.width; ++i) column[static_cast<std::size_t>(i)] += row[i];
      }
      const float share = 1.0f / static_cast<float>(cell * cell);
      float* to = out.data.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(out.width);
      if (cell == 1) {
        std::fill_n(to, pad, column.front());
        std::copy(column.begin(), column.end(), to + pad);
        std::fill_n(to + pad + image.width, pad, column.back());
        continue;
      }
      for (int i = 0; i < out.width; ++i) {
        float sum = 0;
        for (int k = 0; k < cell; ++k) sum += column[static_cast<std::size_t>(std::clamp((i - pad) * cell + k, 0, image.width - 1))];
        to[i] = sum * share;
      }
    }
  }
  return out;
}

/// Kernel applied where it fits: r cells less on every side.
Cells filtered(const Cells& in, const std::vector<float>& w, int threads) {
  const int taps = static_cast<int>(w.size()), r = taps / 2;
  Cells out;
  out.cell = in.cell, out.pad = in.pad - r, out.width = in.width - 2 * r, out.height = in.height - 2 * r;
  const int room = (out.width + kSumLanes - 1) / kSumLanes * kSumLanes;
  const auto stride = static_cast<std::size_t>(room);
  std::vector<float> across(stride * static_cast<std::size_t>(in.height));
  out.data.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
#pragma omp parallel num_threads(threads)
  {
    std::vector<float> line(stride + static_cast<std::size_t>(2 * r)), sum(stride);
    std::vector<const float*> rows(w.size());
#pragma omp for schedule(static)
    for (int j = 0; j < in.height; ++j) {
      std::copy_n(in.data.begin() + static_cast<std::ptrdiff_t>(j) * in.width, in.width, line.begin());
      for (int k = 0; k < taps; ++k) rows[static_cast<std::size_t>(k)] = line.data() + k;
      weighted_sum(rows.data(), w.data(), taps, room, across.data() + static_cast<std::size_t>(j) * stride);
    }
#pragma omp for schedule(static)
    for (int j = 0; j < out.height; ++j) {
      for (int k = 0; k < taps; ++k) rows[static_cast<std::size_t>(k)] = across.data() + static_cast<std::size_t>(j + k) * stride;
      weighted_sum(rows.data(), w.data(), taps, room, sum.data());
      std::copy_n(sum.begin(), out.width, out.data.begin() + static_cast<std::ptrdiff_t>(j) * out.width);
    }
  }
  return out;
}

struct Spline {
  int first;
  std::array<float, 4> weight;
};
/// Cells (pixel centres of cell c at (c + 1/2) cell) that pixel i is between, for every i < n.
std::vector<Spline> splines(int n, const Cells& cells) {
  std::vector<Spline> out;
  for (int i = 0; i < n; ++i) {
    const double u = (i + 0.5) / cells.cell - 0.5, base = std::floor(u), t = u - base, s = 1 - t;
    out.push_back({static_cast<int>(base) - 1 + cells.pad,
                   {static_cast<float>(s * s * s / 6), static_cast<float>((4 - 6 * t * t + 3 * t * t * t) / 6),
                    static_cast<float>((4 - 6 * s * s + 3 * s * s * s) / 6), static_cast<float>(t * t * t / 6)}});
  }
  return out;
}
RasterF enlarged(const Cells& cells, int width, int height, double pitch_m, int threads) {
  RasterF out(width, height, 1, pitch_m);
  const std::vector<Spline> xs = splines(width, cells), ys = splines(height, cells);
#pragma omp parallel num_threads(threads)
  {
    std::vector<float> line(static_cast<std::size_t>(cells.width));
#pragma omp for schedule(static)
    for (int j = 0; j < height; ++j) {
      const Spline& y = ys[static_cast<std::size_t>(j)];
      const float* row = cells.data.data() + static_cast<std::size_t>(y.first) * static_cast<std::size_t>(cells.width);
      for (int i = 0; i < cells.width; ++i)
        line[static_cast<std::size_t>(i)] = y.weight[0] * row[i] + y.weight[1] * row[i + cells.width] + y.weight[2] * row[i + 2 * cells.width] +
                                            y.weight[3] * row[i + 3 * cells.width];
      for (int i = 0; i < width; ++i) {
        const Spline& x = xs[static_cast<std::size_t>(i)];
        const float* at = line.data() + x.first;
        out.at(i, j) = x.weight[0] * at[0] + x.weight[1] * at[1] + x.weight[2] * at[2] + x.weight[3] * at[3];
      }
    }
  }
  return out;
}
}  // namespace

RasterF pixel_blur(const RasterF& image, double sd_px, int threads) {
  VENATO_EXPECTS(image.channels == 1 && sd_px > 0 && std::isfinite(sd_px) && threads > 0);
  if (image.empty()) return image;
  const int cell = std::max(1, static_cast<int>(sd_px / kCellsPerDeviation));
  if (cell == 1) {
    const std::vector<float> w = kernel(sd_px);
    RasterF out(image.width, image.height, 1, image.pitch_m);
    out.data = filtered(averaged(image, 1, static_cast<int>(w.size() / 2), threads), w, threads).data;
    return out;
  }
  // Variances add [cells^2]: averaging (1 - 1/cell^2) / 12, the kernel's own integration over a cell 1/12, the B-spline 1/3; wanted: sd^2 and that of
  // one pixel.
  const double c2 = static_cast<double>(cell) * cell;
  const std::vector<float> w = kernel(std::sqrt((sd_px * sd_px + 1.0 / 12 - (c2 - 1) / 12) / c2 - 1.0 / 12 - 1.0 / 3));
  constexpr int kSplineReach = 2;
  return enlarged(filtered(averaged(image, cell, static_cast<int>(w.size() / 2) + kSplineReach, threads), w, threads), image.width, image.height,
                  image.pitch_m, threads);
}
}  // namespace venato::graphics
