#include <algorithm>
#include <cmath>
#include <utility>
#include "base/expects.h"
#include "sync/registration/gaussian.h"
#include "sync/registration/image_ops.h"
namespace venato::sync {
namespace {
constexpr double kDirectSigma_px = 8;  // larger Gaussians are smooth enough to be computed on a coarser grid
constexpr float kMinWeight = 0.05f;    // below this share of valid neighbourhood a smoothed value would be an extrapolation

/// What the smoothed values must be divided by; without holes the product of two border lines says it all.
struct Norm {
  int width = 0;
  std::vector<float> weight, across, down;
  float at(int i, int j) const {
    const auto x = static_cast<std::size_t>(i), y = static_cast<std::size_t>(j);
    return weight.empty() ? across[x] * down[y] : weight[y * static_cast<std::size_t>(width) + x];
  }
};
Norm norm_of(const graphics::Raster8& valid, double sigma_px, int threads) {
  const int w = valid.width, h = valid.height;
  if (std::all_of(valid.data.begin(), valid.data.end(), [](std::uint8_t v) { return v != 0; }))
    return {w, {}, gaussian_inside(w, sigma_px), gaussian_inside(h, sigma_px)};
  std::vector<float> ones(valid.data.size()), weight(ones.size());
  for (std::size_t k = 0; k < ones.size(); ++k) ones[k] = valid.data[k] ? 1.0f : 0.0f;
  gaussian(ones, w, h, sigma_px, threads, weight);
  return {w, std::move(weight), {}, {}};
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

/// Divides out the weight; pixels outside f's valid ones only with `extend`.
void normalise(const Feature& f, const Norm& norm, bool extend, int threads, Feature& out) {
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < f.value.height; ++j)
    for (int i = 0; i < f.value.width; ++i) {
      const std::size_t k = f.value.index(i, j);
      const float n = norm.at(i, j);
      const bool ok = (extend || f.valid.data[k]) && n > kMinWeight;
      out.value.data[k] = ok ? out.value.data[k] / n : 0;
      out.valid.data[k] = ok ? 255 : 0;
    }
}

Feature empty_like(const Feature& f) {
  return {graphics::RasterF(f.value.width, f.value.height, 1, f.value.pitch_m), graphics::Raster8(f.value.width, f.value.height, 1, f.value.pitch_m)};
}

Feature smooth_any(const Feature& f, double sigma_px, bool extend, int threads) {
  Feature out = empty_like(f);
  const int w = f.value.width, h = f.value.height;
  if (sigma_px <= kDirectSigma_px) {
    gaussian(f.value.data, w, h, sigma_px, threads, out.value.data);
    normalise(f, norm_of(f.valid, sigma_px, threads), extend, threads, out);
    return out;
  }
  const int factor = static_cast<int>(sigma_px / (kDirectSigma_px / 2));
  const Feature small = downsample(f, factor, threads);
  const int sw = small.value.width, sh = small.value.height;
  std::vector<float> sums(small.value.data.size());
  gaussian(small.value.data, sw, sh, sigma_px / factor, threads, sums);
  const Norm norm = norm_of(small.valid, sigma_px / factor, threads);
  const std::vector<Between> columns = between(w, sw, factor), rows = between(h, sh, factor);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < h; ++j) {
    const Between& y = rows[static_cast<std::size_t>(j)];
    const float* low = sums.data() + small.value.index(0, y.low);
    const float* high = sums.data() + small.value.index(0, y.high);
    for (int i = 0; i < w; ++i) {
      const std::size_t k = f.value.index(i, j);
      if (!extend && !f.valid.data[k]) continue;
      const Between& x = columns[static_cast<std::size_t>(i)];
      const auto mix = [&](float a, float b, float c, float d) {
        const float top = a + x.share * (b - a), bottom = c + x.share * (d - c);
        return top + y.share * (bottom - top);
      };
      const float sum = mix(low[x.low], low[x.high], high[x.low], high[x.high]);
      const float n = mix(norm.at(x.low, y.low), norm.at(x.high, y.low), norm.at(x.low, y.high), norm.at(x.high, y.high));
      if (!(n > kMinWeight)) continue;
      out.valid.data[k] = 255;
      out.value.data[k] = sum / n;
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
