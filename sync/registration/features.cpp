#include "sync/registration/features.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>
namespace venato::sync {
namespace {
constexpr double kFine_m = 0.0025, kCoarse_m = 0.040;         // band of vein widths in a picture
constexpr double kMinGrain_m = 0.0010, kMaxGrain_m = 0.0030;  // granule speckle (0.3 mm grains) up to half a narrow vein
constexpr double kNoiseShare = 0.125;
constexpr double kRim = 1.6;  // sigmas from the border: there 95 % of a Gaussian lies inside
constexpr double kGradient_m = 0.0020, kLocalMean_m = 0.030;
constexpr float kGradientClip = 4;

/// (d/dx, d/dy) by central differences; 0 and invalid where a neighbour is invalid.
struct Slopes {
  Feature x, y;
};
Slopes slopes(const Feature& f) {
  Slopes s{f, f};
  const int w = f.value.width, h = f.value.height;
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      const std::size_t k = f.value.index(i, j);
      const bool ok =
          i > 0 && j > 0 && i + 1 < w && j + 1 < h && f.valid.at(i - 1, j) && f.valid.at(i + 1, j) && f.valid.at(i, j - 1) && f.valid.at(i, j + 1);
      s.x.value.data[k] = ok ? (f.value.at(i + 1, j) - f.value.at(i - 1, j)) / 2 : 0;
      s.y.value.data[k] = ok ? (f.value.at(i, j + 1) - f.value.at(i, j - 1)) / 2 : 0;
      s.x.valid.data[k] = s.y.valid.data[k] = ok ? 255 : 0;
    }
  return s;
}
}  // namespace

double wanted_smoothing_m(const Feature& base) {
  const graphics::RasterF& v = base.value;
  std::vector<float> response;
  for (int j = 1; j + 1 < v.height; j += 2)
    for (int i = 1; i + 1 < v.width; i += 2) {
      bool ok = true;
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) ok = ok && base.valid.at(i + x, j + y);
      if (!ok) continue;
      response.push_back(std::abs(v.at(i - 1, j - 1) - 2 * v.at(i, j - 1) + v.at(i + 1, j - 1) - 2 * v.at(i - 1, j) + 4 * v.at(i, j) -
                                  2 * v.at(i + 1, j) + v.at(i - 1, j + 1) - 2 * v.at(i, j + 1) + v.at(i + 1, j + 1)));
    }
  if (response.empty()) return kMinGrain_m;
  std::nth_element(response.begin(), response.begin() + static_cast<std::ptrdiff_t>(response.size() / 2), response.end());
  const double noise = static_cast<double>(response[response.size() / 2]) / (0.6745 * 6);  // 6 = norm of the mask
  const double contrast = moments(smooth(base, kMaxGrain_m / v.pitch_m)).deviation;
  if (!(contrast > 0)) return kMinGrain_m;
  // A Gaussian of s pixels leaves noise / (2 sqrt(pi) s) of white noise.
  const double sigma_px = noise / (2 * std::sqrt(std::numbers::pi) * kNoiseShare * contrast);
  return std::clamp(sigma_px * v.pitch_m, kMinGrain_m, kMaxGrain_m);
}

Feature band_pass(const Feature& base, double grain_m, const graphics::Raster8& footprint) {
  const double pitch_m = base.value.pitch_m;
  const double fine_px = std::max(kFine_m, grain_m) / pitch_m;
  Feature out = without_rim(smooth(base, fine_px), static_cast<int>(std::lround(kRim * fine_px))), inside = base;
  for (std::size_t k = 0; k < inside.value.data.size(); ++k)
    if (!footprint.data[k]) inside.value.data[k] = inside.valid.data[k] = 0;
  const Feature background = smooth_and_extend(inside, kCoarse_m / pitch_m);
  for (std::size_t k = 0; k < out.value.data.size(); ++k) {
    if (!background.valid.data[k]) out.valid.data[k] = 0;
    out.value.data[k] = out.valid.data[k] ? out.value.data[k] - background.value.data[k] : 0;
  }
  return out;
}

Features make_features(const Feature& base, bool as_picture, double grain_m) {
  Features out;
  const double pitch_m = base.value.pitch_m;
  if (as_picture) {
    out.signed_evidence = band_pass(base, grain_m, base.valid);
  } else {
    out.signed_evidence = smooth(base, grain_m / pitch_m);
  }
  out.contrast = moments(out.signed_evidence).deviation;

  const Slopes s = slopes(smooth(base, std::max(kGradient_m, grain_m) / pitch_m));
  out.gradient = s.x;
  for (std::size_t k = 0; k < out.gradient.value.data.size(); ++k) out.gradient.value.data[k] = std::hypot(s.x.value.data[k], s.y.value.data[k]);
  const Feature local = smooth(out.gradient, kLocalMean_m / pitch_m);
  // The floor keeps veinless areas, whose local mean is only noise, from being raised to the level of veins.
  const auto floor = static_cast<float>(0.5 * moments(out.gradient).mean + 1e-12);
  for (std::size_t k = 0; k < out.gradient.value.data.size(); ++k)
    out.gradient.value.data[k] =
        out.gradient.valid.data[k] ? std::min(kGradientClip, out.gradient.value.data[k] / std::max(floor, local.value.data[k])) : 0;

  const Slopes structure = slopes(smooth(out.signed_evidence, 0.003 / pitch_m));
  Eigen::Matrix2d tensor = Eigen::Matrix2d::Zero();
  for (std::size_t k = 0; k < structure.x.value.data.size(); ++k) {
    const Point g(static_cast<double>(structure.x.value.data[k]), static_cast<double>(structure.y.value.data[k]));
    tensor += g * g.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(tensor);
  out.weak_direction = eigen.eigenvectors().col(0);
  out.isotropy = eigen.eigenvalues()(1) > 0 ? std::max(0.0, eigen.eigenvalues()(0)) / eigen.eigenvalues()(1) : 0;
  return out;
}
}  // namespace venato::sync
