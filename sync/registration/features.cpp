#include "sync/registration/features.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
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
constexpr double kStructure_m = 0.003, kEdgeGrid_m = 0.002;  // edges are smoothed by 2 mm and more: finer pixels add nothing

bool has_neighbours(const Feature& f, int i, int j) {
  return i > 0 && j > 0 && i + 1 < f.value.width && j + 1 < f.value.height && f.valid.at(i - 1, j) && f.valid.at(i + 1, j) && f.valid.at(i, j - 1) &&
         f.valid.at(i, j + 1);
}
/// (d/dx, d/dy) by central differences [1/px].
Point slope(const Feature& f, int i, int j) {
  return Point(static_cast<double>(f.value.at(i + 1, j) - f.value.at(i - 1, j)), static_cast<double>(f.value.at(i, j + 1) - f.value.at(i, j - 1))) /
         2;
}
/// Edge strength; 0 and invalid where a neighbour is invalid.
Feature edges(const Feature& f, int threads) {
  const int w = f.value.width, h = f.value.height;
  Feature out{graphics::RasterF(w, h, 1, f.value.pitch_m), graphics::Raster8(w, h, 1, f.value.pitch_m)};
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      if (!has_neighbours(f, i, j)) continue;
      out.value.at(i, j) = static_cast<float>(slope(f, i, j).norm());
      out.valid.at(i, j) = 255;
    }
  return out;
}
Eigen::Matrix2d structure_tensor(const Feature& f, int threads) {
  std::vector<Eigen::Matrix2d> rows(static_cast<std::size_t>(f.value.height), Eigen::Matrix2d::Zero());
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < f.value.height; ++j)
    for (int i = 0; i < f.value.width; ++i) {
      if (!has_neighbours(f, i, j)) continue;
      const Point g = slope(f, i, j);
      rows[static_cast<std::size_t>(j)] += g * g.transpose();
    }
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const Eigen::Matrix2d& r : rows) sum += r;
  return sum;
}
}  // namespace

int edge_factor(double pitch_m) { return std::max(1, static_cast<int>(std::lround(kEdgeGrid_m / pitch_m))); }

double wanted_smoothing_m(const Feature& base, int threads) {
  const graphics::RasterF& v = base.value;
  // Every fourth row is enough for a median; rows fill their own part, so threads do not change the order.
  const int rows = std::max(0, (v.height - 2 + 3) / 4), columns = std::max(0, (v.width - 2 + 2) / 3);
  std::vector<float> all(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), -1.0f);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int i = 1 + 3 * c, j = 1 + 4 * r;
      bool ok = true;
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) ok = ok && base.valid.at(i + x, j + y);
      if (!ok) continue;
      all[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)] =
          std::abs(v.at(i - 1, j - 1) - 2 * v.at(i, j - 1) + v.at(i + 1, j - 1) - 2 * v.at(i - 1, j) + 4 * v.at(i, j) - 2 * v.at(i + 1, j) +
                   v.at(i - 1, j + 1) - 2 * v.at(i, j + 1) + v.at(i + 1, j + 1));
    }
  std::vector<float> response;
  std::copy_if(all.begin(), all.end(), std::back_inserter(response), [](float x) { return x >= 0; });
  if (response.empty()) return kMinGrain_m;
  std::nth_element(response.begin(), response.begin() + static_cast<std::ptrdiff_t>(response.size() / 2), response.end());
  const double noise = static_cast<double>(response[response.size() / 2]) / (0.6745 * 6);  // 6 = norm of the mask
  const int factor = edge_factor(v.pitch_m);
  const double contrast = moments(smooth(downsample(base, factor, threads), kMaxGrain_m / (factor * v.pitch_m), threads), threads).deviation;
  if (!(contrast > 0)) return kMinGrain_m;
  // A Gaussian of s pixels leaves noise / (2 sqrt(pi) s) of white noise.
  const double sigma_px = noise / (2 * std::sqrt(std::numbers::pi) * kNoiseShare * contrast);
  return std::clamp(sigma_px * v.pitch_m, kMinGrain_m, kMaxGrain_m);
}

Feature band_pass(const Feature& base, double grain_m, const graphics::Raster8& footprint, int threads) {
  const double pitch_m = base.value.pitch_m;
  const double fine_px = std::max(kFine_m, grain_m) / pitch_m;
  Feature out = without_rim(smooth(base, fine_px, threads), static_cast<int>(std::lround(kRim * fine_px))), inside = base;
  for (std::size_t k = 0; k < inside.value.data.size(); ++k)
    if (!footprint.data[k]) inside.value.data[k] = inside.valid.data[k] = 0;
  const Feature background = smooth_and_extend(inside, kCoarse_m / pitch_m, threads);
  for (std::size_t k = 0; k < out.value.data.size(); ++k) {
    if (!background.valid.data[k]) out.valid.data[k] = 0;
    out.value.data[k] = out.valid.data[k] ? out.value.data[k] - background.value.data[k] : 0;
  }
  return out;
}

Features make_features(const Feature& base, bool as_picture, double grain_m, int threads) {
  Features out;
  const double pitch_m = base.value.pitch_m;
  out.signed_evidence = as_picture ? band_pass(base, grain_m, base.valid, threads) : smooth(base, grain_m / pitch_m, threads);
  out.contrast = moments(out.signed_evidence, threads).deviation;

  const int factor = edge_factor(pitch_m);
  out.gradient = edges(smooth(downsample(base, factor, threads), std::max(kGradient_m, grain_m) / (factor * pitch_m), threads), threads);
  const Feature local = smooth(out.gradient, kLocalMean_m / (factor * pitch_m), threads);
  // The floor keeps veinless areas, whose local mean is only noise, from being raised to the level of veins.
  const auto floor = static_cast<float>(0.5 * moments(out.gradient, threads).mean + 1e-12);
  for (std::size_t k = 0; k < out.gradient.value.data.size(); ++k)
    out.gradient.value.data[k] =
        out.gradient.valid.data[k] ? std::min(kGradientClip, out.gradient.value.data[k] / std::max(floor, local.value.data[k])) : 0;

  const Feature small = smooth(downsample(out.signed_evidence, factor, threads), kStructure_m / (factor * pitch_m), threads);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(structure_tensor(small, threads));
  out.weak_direction = eigen.eigenvectors().col(0);
  out.isotropy = eigen.eigenvalues()(1) > 0 ? std::max(0.0, eigen.eigenvalues()(0)) / eigen.eigenvalues()(1) : 0;
  return out;
}
}  // namespace venato::sync
