#include <algorithm>
#include <cmath>
#include "base/expects.h"
#include "sync/registration/gaussian.h"
#include "sync/registration/image_ops.h"
namespace venato::sync {
namespace {
constexpr double kDirectSigma_px = 8;  // larger Gaussians are smooth enough to be computed on a coarser grid
constexpr float kMinWeight = 0.05f;    // below this share of valid neighbourhood a smoothed value would be an extrapolation

/// Smoothed sum and weight of one grid; `weight` is empty where the product of the two border lines says it all.
struct Smoothed {
  int width = 0, height = 0;
  std::vector<float> sum, weight, across, down;
  float norm(int i, int j) const {
    return weight.empty() ? across[static_cast<std::size_t>(i)] * down[static_cast<std::size_t>(j)] : weight[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
  }
};
Smoothed smoothed(const Feature& f, double sigma_px, int threads) {
  const int w = f.value.width, h = f.value.height;
  Smoothed out{w, h, gaussian(f.value.data, w, h, sigma_px, threads), {}, {}, {}};
  if (std::all_of(f.valid.data.begin(), f.valid.data.end(), [](std::uint8_t v) { return v != 0; })) {
    out.across = gaussian_inside(w, sigma_px);
    out.down = gaussian_inside(h, sigma_px);
    return out;
  }
  std::vector<float> ones(f.valid.data.size());
  for (std::size_t k = 0; k < ones.size(); ++k) ones[k] = f.valid.data[k] ? 1.0f : 0.0f;
  out.weight = gaussian(ones, w, h, sigma_px, threads);
  return out;
}

/// Where fine pixel i lies on a grid `factor` times coarser: coarse I covers fine [I k, (I + 1) k).
struct Between {
  int low, high;
  float share;  ///< of `high`
};
std::vector<Between> between(int fine, int coarse, int factor) {
  std::vector<Between> out;
  for (int i = 0; i < fine; ++i) {
    const float at = (static_cast<float>(i) + 0.5f) / static_cast<float>(factor) - 0.5f, low = std::floor(at);
    const auto clamp = [&](int c) { return std::clamp(c, 0, coarse - 1); };
    out.push_back({clamp(static_cast<int>(low)), clamp(static_cast<int>(low) + 1), at - low});
  }
  return out;
}

Feature smooth_any(const Feature& f, double sigma_px, bool extend, int threads) {
  const int factor = sigma_px > kDirectSigma_px ? static_cast<int>(sigma_px / (kDirectSigma_px / 2)) : 1;
  const Smoothed s = factor > 1 ? smoothed(downsample(f, factor, threads), sigma_px / factor, threads) : smoothed(f, sigma_px, threads);
  const int w = f.value.width, h = f.value.height;
  const std::vector<Between> columns = between(w, s.width, factor), rows = between(h, s.height, factor);
  Feature out{graphics::RasterF(w, h, 1, f.value.pitch_m), graphics::Raster8(w, h, 1, f.value.pitch_m)};
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < h; ++j) {
    const Between& y = rows[static_cast<std::size_t>(j)];
    const float* low = s.sum.data() + static_cast<std::size_t>(y.low) * static_cast<std::size_t>(s.width);
    const float* high = s.sum.data() + static_cast<std::size_t>(y.high) * static_cast<std::size_t>(s.width);
    for (int i = 0; i < w; ++i) {
      const std::size_t k = f.value.index(i, j);
      if (!extend && !f.valid.data[k]) continue;
      float sum, norm;
      if (factor == 1) {
        sum = low[i];
        norm = s.norm(i, j);
      } else {
        const Between& x = columns[static_cast<std::size_t>(i)];
        const auto mix = [&](float a, float b, float c, float d) {
          const float top = a + x.share * (b - a), bottom = c + x.share * (d - c);
          return top + y.share * (bottom - top);
        };
        sum = mix(low[x.low], low[x.high], high[x.low], high[x.high]);
        norm = mix(s.norm(x.low, y.low), s.norm(x.high, y.low), s.norm(x.low, y.high), s.norm(x.high, y.high));
      }
      if (!(norm > kMinWeight)) continue;
      out.valid.data[k] = 255;
      out.value.data[k] = sum / norm;
    }
  }
  return out;
}
}  // namespace

Feature smooth(const Feature& f, double sigma_px, int threads) {
  VENATO_EXPECTS(!f.value.empty());
  return sigma_px > 0 ? smooth_any(f, sigma_px, false, threads) : f;
}
Feature smooth_and_extend(const Feature& f, double sigma_px, int threads) {
  VENATO_EXPECTS(!f.value.empty() && sigma_px > 0);
  return smooth_any(f, sigma_px, true, threads);
}
}  // namespace venato::sync
