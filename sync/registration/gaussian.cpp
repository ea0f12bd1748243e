#include "sync/registration/gaussian.h"
#include <algorithm>
#include <cmath>
#include "base/expects.h"
#include "graphics/raster/weighted_sum.h"
namespace venato::sync {
namespace {
using graphics::kSumLanes;
using graphics::weighted_sum;

constexpr double kCut = 3.5;  // sigmas

std::vector<float> kernel(double sigma_px) {
  const int r = static_cast<int>(std::ceil(kCut * sigma_px));
  std::vector<double> exact;
  double sum = 0;
  for (int k = -r; k <= r; ++k) {
    exact.push_back(std::exp(-k * k / (2 * sigma_px * sigma_px)));
    sum += exact.back();
  }
  std::vector<float> out;
  for (const double v : exact) out.push_back(static_cast<float>(v / sum));
  return out;
}
}  // namespace

std::vector<float> gaussian_inside(int n, double sigma_px) {
  const std::vector<float> w = kernel(sigma_px);
  const int r = static_cast<int>(w.size() / 2);
  std::vector<float> out(static_cast<std::size_t>(n), 0.0f);
  for (int i = 0; i < n; ++i)
    for (int k = std::max(-r, -i); k <= std::min(r, n - 1 - i); ++k) out[static_cast<std::size_t>(i)] += w[static_cast<std::size_t>(k + r)];
  return out;
}

void gaussian(std::span<const float> data, int width, int height, double sigma_px, int threads, std::span<float> out) {
  VENATO_EXPECTS(sigma_px > 0 && out.size() == data.size() && out.data() != data.data() &&
                 data.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const std::vector<float> w = kernel(sigma_px);
  const int taps = static_cast<int>(w.size()), r = taps / 2;
  const int room = (width + kSumLanes - 1) / kSumLanes * kSumLanes;  // row length with whole lanes
  // A strip's rows across stay in the second-level cache while they are summed down.
  const int strip = std::max(64, 4 * r), strips = (height + strip - 1) / strip;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (int s = 0; s < strips; ++s) {
    const int from = s * strip, to = std::min(height, from + strip);
    const std::vector<float> nothing(static_cast<std::size_t>(room), 0.0f);
    std::vector<float> padded(static_cast<std::size_t>(room + 2 * r), 0.0f), line(static_cast<std::size_t>(room));
    std::vector<float> across(static_cast<std::size_t>(room) * static_cast<std::size_t>(to - from + 2 * r));
    std::vector<const float*> rows(static_cast<std::size_t>(taps)), below(static_cast<std::size_t>(to - from + 2 * r));
    for (int k = 0; k < taps; ++k) rows[static_cast<std::size_t>(k)] = padded.data() + k;
    for (int y = from - r; y < to + r; ++y) {
      const auto at = static_cast<std::size_t>(y - from + r);
      below[at] = nothing.data();
      if (y < 0 || y >= height) continue;
      std::copy_n(data.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width), width, padded.begin() + r);
      float* const to_row = across.data() + at * static_cast<std::size_t>(room);
      weighted_sum(rows.data(), w.data(), taps, room, to_row);
      below[at] = to_row;
    }
    for (int y = from; y < to; ++y) {
      weighted_sum(below.data() + (y - from), w.data(), taps, room, line.data());
      std::copy_n(line.begin(), width, out.begin() + static_cast<std::ptrdiff_t>(y) * width);
    }
  }
}
}  // namespace venato::sync
