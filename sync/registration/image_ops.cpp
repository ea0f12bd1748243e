#include "sync/registration/image_ops.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>
#include "base/expects.h"
namespace venato::sync {
namespace {

/// Overlap lengths of destination cell [d, d + 1) * ratio with source cells.
struct Overlap {
  int first = 0;
  std::vector<float> length;
};
std::vector<Overlap> box_overlaps(int destination, int source, double ratio) {
  std::vector<Overlap> out(static_cast<std::size_t>(destination));
  for (int d = 0; d < destination; ++d) {
    const double lo = d * ratio, hi = std::min((d + 1) * ratio, static_cast<double>(source));
    Overlap& o = out[static_cast<std::size_t>(d)];
    o.first = std::min(static_cast<int>(lo), source - 1);
    for (int s = o.first; s < source && s < hi; ++s)
      o.length.push_back(static_cast<float>(std::max(0.0, std::min(hi, s + 1.0) - std::max(lo, static_cast<double>(s)))));
  }
  return out;
}

std::array<float, 4> catmull_rom(float f) {
  return {f * (-0.5f + f * (1 - 0.5f * f)), 1 + f * f * (1.5f * f - 2.5f), f * (0.5f + f * (2 - 1.5f * f)), f * f * (0.5f * f - 0.5f)};
}

/// Value at pixel coordinates (pixel centre = integer); false if any of the inner 2 x 2 pixels is invalid or outside.
bool sample(const Feature& f, double x, double y, float& value) {
  const int w = f.value.width, h = f.value.height;
  if (!(x >= -0.5 && y >= -0.5 && x <= w - 0.5 && y <= h - 0.5)) return false;
  // Within half a pixel of the rim the nearest column is all there is.
  x = std::clamp(x, 0.0, w - 1.0);
  y = std::clamp(y, 0.0, h - 1.0);
  const int i = std::min(static_cast<int>(x), std::max(0, w - 2)), j = std::min(static_cast<int>(y), std::max(0, h - 2));
  const auto fx = catmull_rom(static_cast<float>(x - i)), fy = catmull_rom(static_cast<float>(y - j));
  const int i1 = std::min(i + 1, w - 1), j1 = std::min(j + 1, h - 1);
  if (!f.valid.at(i, j) || !f.valid.at(i1, j) || !f.valid.at(i, j1) || !f.valid.at(i1, j1)) return false;
  const auto across = [&](const float* row, int a, int b, int c, int d) { return fx[0] * row[a] + fx[1] * row[b] + fx[2] * row[c] + fx[3] * row[d]; };
  if (i > 0 && j > 0 && i + 2 < w && j + 2 < h) {  // away from the rim: four rows at fixed distance
    const float* row = f.value.data.data() + f.value.index(i - 1, j - 1);
    value = 0;
    for (std::size_t r = 0; r < 4; ++r, row += w) value += fy[r] * across(row, 0, 1, 2, 3);
    return true;
  }
  const int columns[4] = {std::max(i - 1, 0), i, i1, std::min(i + 2, w - 1)}, rows[4] = {std::max(j - 1, 0), j, j1, std::min(j + 2, h - 1)};
  float sum = 0;
  for (std::size_t r = 0; r < 4; ++r)
    sum += fy[r] * across(f.value.data.data() + f.value.index(0, rows[r]), columns[0], columns[1], columns[2], columns[3]);
  value = sum;
  return true;
}
}  // namespace

Feature resample(const Evidence& evidence, double pitch_m, int threads) {
  const graphics::RasterF& in = evidence.value;
  VENATO_EXPECTS(!in.empty() && in.channels == 1 && in.pitch_m > 0 && pitch_m > 0);
  Feature clean{in, graphics::Raster8(in.width, in.height, 1, in.pitch_m, 255)};
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < in.height; ++j)
    for (std::size_t k = in.index(0, j); k < in.index(0, j + 1); ++k)
      if (!std::isfinite(in.data[k]) || (!evidence.valid.empty() && !evidence.valid.data[k])) {
        clean.value.data[k] = 0;
        clean.valid.data[k] = 0;
      }
  const double ratio = pitch_m / in.pitch_m;
  if (std::abs(ratio - 1) < 1e-9) return clean;
  const int w = std::max(1, static_cast<int>(std::lround(in.width / ratio))), h = std::max(1, static_cast<int>(std::lround(in.height / ratio)));
  Feature out{graphics::RasterF(w, h, 1, pitch_m), graphics::Raster8(w, h, 1, pitch_m)};
  if (ratio < 1) {
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int j = 0; j < h; ++j)
      for (int i = 0; i < w; ++i) {
        float v = 0;
        if (!sample(clean, (i + 0.5) * ratio - 0.5, (j + 0.5) * ratio - 0.5, v)) continue;
        out.value.at(i, j) = v;
        out.valid.at(i, j) = 255;
      }
    return out;
  }
  const std::vector<Overlap> columns = box_overlaps(w, in.width, ratio), rows = box_overlaps(h, in.height, ratio);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      const Overlap &cx = columns[static_cast<std::size_t>(i)], &cy = rows[static_cast<std::size_t>(j)];
      double sum = 0, weight = 0, total = 0;
      for (std::size_t r = 0; r < cy.length.size(); ++r)
        for (std::size_t c = 0; c < cx.length.size(); ++c) {
          const std::size_t k = clean.value.index(cx.first + static_cast<int>(c), cy.first + static_cast<int>(r));
          const double area = static_cast<double>(cy.length[r]) * static_cast<double>(cx.length[c]);
          total += area;
          if (!clean.valid.data[k]) continue;
          weight += area;
          sum += area * static_cast<double>(clean.value.data[k]);
        }
      if (!(weight > 0.5 * total)) continue;
      out.value.at(i, j) = static_cast<float>(sum / weight);
      out.valid.at(i, j) = 255;
    }
  return out;
}

Feature downsample(const Feature& f, int factor, int threads) {
  VENATO_EXPECTS(factor >= 1);
  if (factor == 1) return f;
  const int w = (f.value.width + factor - 1) / factor, h = (f.value.height + factor - 1) / factor;
  const double pitch_m = f.value.pitch_m * factor;
  Feature out{graphics::RasterF(w, h, 1, pitch_m), graphics::Raster8(w, h, 1, pitch_m)};
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < h; ++j) {
    const int j0 = j * factor, j1 = std::min(f.value.height, j0 + factor);
    for (int i = 0; i < w; ++i) {
      const int i0 = i * factor, i1 = std::min(f.value.width, i0 + factor);
      float sum = 0;
      int count = 0;
      for (int y = j0; y < j1; ++y) {
        const std::size_t row = f.value.index(0, y);
        for (std::size_t k = row + static_cast<std::size_t>(i0); k < row + static_cast<std::size_t>(i1); ++k) {
          sum += f.value.data[k];  // 0 where invalid
          count += f.valid.data[k] ? 1 : 0;
        }
      }
      if (2 * count <= (i1 - i0) * (j1 - j0)) continue;
      out.value.at(i, j) = sum / static_cast<float>(count);
      out.valid.at(i, j) = 255;
    }
  }
  return out;
}

namespace {
/// Sums of 1, a, b, a^2, b^2, ab over the pixels valid on both sides; rows are added in order, so threads do not change the sum.
std::array<double, 6> sums(const Feature& a, const Feature& b, int threads) {
  VENATO_EXPECTS(a.value.width == b.value.width && a.value.height == b.value.height);
  std::vector<std::array<double, 6>> rows(static_cast<std::size_t>(a.value.height));
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < a.value.height; ++j) {
    std::array<double, 6> s{};
    for (std::size_t k = a.value.index(0, j); k < a.value.index(0, j + 1); ++k) {
      if (!a.valid.data[k] || !b.valid.data[k]) continue;
      const double x = static_cast<double>(a.value.data[k]), y = static_cast<double>(b.value.data[k]);
      s[0] += 1;
      s[1] += x;
      s[2] += y;
      s[3] += x * x;
      s[4] += y * y;
      s[5] += x * y;
    }
    rows[static_cast<std::size_t>(j)] = s;
  }
  std::array<double, 6> total{};
  for (const auto& row : rows)
    for (std::size_t k = 0; k < 6; ++k) total[k] += row[k];
  return total;
}
}  // namespace

Moments moments(const Feature& f, int threads) {
  const std::array<double, 6> s = sums(f, f, threads);
  if (s[0] == 0) return {};
  const double mean = s[1] / s[0];
  return {mean, std::sqrt(std::max(0.0, s[3] / s[0] - mean * mean)), s[0]};
}

double masked_ncc(const Feature& a, const Feature& b, int threads) {
  const std::array<double, 6> s = sums(a, b, threads);
  const double va = s[0] * s[3] - s[1] * s[1], vb = s[0] * s[4] - s[2] * s[2];
  return va > 0 && vb > 0 ? (s[0] * s[5] - s[1] * s[2]) / std::sqrt(va * vb) : 0;
}

Feature warp_to_green(const Feature& print, const Transform& print_from_green, int width, int height, int threads) {
  const double pitch = print.value.pitch_m;
  Feature out{graphics::RasterF(width, height, 1, pitch), graphics::Raster8(width, height, 1, pitch)};
  const RowDisplacement displacement(print_from_green.u, 0.5 * pitch, pitch, width);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < height; ++j) {
    std::vector<double> ux(static_cast<std::size_t>(width)), uy(ux.size());
    const double y = (j + 0.5) * pitch;
    displacement.at(y, width, ux.data(), uy.data());
    for (int i = 0; i < width; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double gx = (i + 0.5) * pitch + ux[k], gy = y + uy[k];
      const Eigen::Matrix2d& a = print_from_green.a;
      const double px = a(0, 0) * gx + a(0, 1) * gy + print_from_green.t.x(), py = a(1, 0) * gx + a(1, 1) * gy + print_from_green.t.y();
      float v = 0;
      if (!sample(print, px / pitch - 0.5, py / pitch - 0.5, v)) continue;
      out.value.at(i, j) = v;
      out.valid.at(i, j) = 255;
    }
  }
  return out;
}
}  // namespace venato::sync
