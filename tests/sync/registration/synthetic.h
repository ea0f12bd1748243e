#pragma once
/// Synthetic slab/graphic pairs with known truth, shared by the registration tests.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <vector>
#include "base/rng.h"
#include "graphics/raster/raster.h"
#include "sync/registration/registration.h"
namespace venato::sync::synthetic {

/// Lightness 0..1 of a picture at 1 px/mm (sRGB luma stands in for L*: the tests need veins, not colorimetry).
inline graphics::RasterF load_lightness(const std::string& file) {
  const cv::Mat image = cv::imread(file, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw std::runtime_error("cannot read " + file);
  graphics::RasterF out(image.cols, image.rows, 1, 0.001);
  for (int j = 0; j < image.rows; ++j)
    for (int i = 0; i < image.cols; ++i) out.at(i, j) = static_cast<float>(image.at<std::uint8_t>(j, i)) / 255.0f;
  return out;
}

inline graphics::RasterF blurred(const graphics::RasterF& in, double sigma_px) {
  if (sigma_px <= 0) return in;
  graphics::RasterF out = in;
  const cv::Mat from(in.height, in.width, CV_32F, const_cast<float*>(in.data.data()));
  cv::Mat to(in.height, in.width, CV_32F, out.data.data());
  cv::GaussianBlur(from, to, {0, 0}, sigma_px, sigma_px, cv::BORDER_REPLICATE);
  return out;
}

/// Vein fraction as a plan would have it: how much darker than the 120 mm background, soft threshold 0.06..0.20.
inline graphics::RasterF vein_plan(const graphics::RasterF& lightness) {
  const graphics::RasterF background = blurred(lightness, 50), fine = blurred(lightness, 1.0);
  graphics::RasterF out = lightness;
  for (std::size_t k = 0; k < out.data.size(); ++k) {
    const float darkness = background.data[k] - fine.data[k];
    const float s = std::clamp((darkness - 0.06f) / 0.14f, 0.0f, 1.0f);
    out.data[k] = s * s * (3 - 2 * s);
  }
  return out;
}

inline graphics::RasterF crop(const graphics::RasterF& in, int x0, int y0, int w, int h) {
  graphics::RasterF out(w, h, 1, in.pitch_m);
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) out.at(i, j) = in.at(std::clamp(x0 + i, 0, in.width - 1), std::clamp(y0 + j, 0, in.height - 1));
  return out;
}
inline graphics::RasterF mirrored(const graphics::RasterF& in) {
  graphics::RasterF out = in;
  for (int j = 0; j < in.height; ++j)
    for (int i = 0; i < in.width; ++i) out.at(i, j) = in.at(in.width - 1 - i, j);
  return out;
}

/// Catmull-Rom at p [m]; edge pixels continue outward.
inline double sample(const graphics::RasterF& f, Point p) {
  const double x = p.x() / f.pitch_m - 0.5, y = p.y() / f.pitch_m - 0.5;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto weights = [](double t) {
    return std::array<double, 4>{t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (1.5 * t - 2.5), t * (0.5 + t * (2 - 1.5 * t)), t * t * (0.5 * t - 0.5)};
  };
  const auto wx = weights(x - i), wy = weights(y - j);
  double sum = 0;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      sum += wy[static_cast<std::size_t>(r)] * wx[static_cast<std::size_t>(c)] *
             static_cast<double>(f.at(std::clamp(i + c - 1, 0, f.width - 1), std::clamp(j + r - 1, 0, f.height - 1)));
  return sum;
}

/// True map of a slab: similarity and stretch about the slab's centre, plus a smooth sum of plane waves (250 to 600 mm) of largest length
/// amplitude_m.
struct Truth {
  Eigen::Matrix2d a = Eigen::Matrix2d::Identity();
  Point t = Point::Zero();
  struct Wave {
    Point k, direction;
    double phase;
  };
  std::vector<Wave> waves;
  double gain = 0;
  Point operator()(Point p) const {
    Point u = Point::Zero();
    for (const Wave& w : waves) u += w.direction * std::sin(w.k.dot(p) + w.phase);
    return a * (p + gain * u) + t;
  }
};
struct WarpSettings {
  double rotation_rad = 0, stretch_x = 1, stretch_y = 1, amplitude_m = 0;
  Point shift_m = Point::Zero();
};
inline Truth make_truth(const WarpSettings& s, double width_m, double height_m, std::uint64_t seed) {
  Truth out;
  Eigen::Matrix2d rotation;
  rotation << std::cos(s.rotation_rad), -std::sin(s.rotation_rad), std::sin(s.rotation_rad), std::cos(s.rotation_rad);
  out.a = rotation * Eigen::Vector2d(s.stretch_x, s.stretch_y).asDiagonal();
  const Point centre(width_m / 2, height_m / 2);
  out.t = centre + s.shift_m - out.a * centre;
  Rng rng(seed, stream_id("tests/sync/truth"));
  for (int k = 0; k < 8; ++k) {
    const double wavelength = 0.25 + 0.35 * rng.uniform(), heading = 2 * M_PI * rng.uniform(), sense = 2 * M_PI * rng.uniform();
    out.waves.push_back(
        {2 * M_PI / wavelength * Point(std::cos(heading), std::sin(heading)), Point(std::cos(sense), std::sin(sense)), 2 * M_PI * rng.uniform()});
  }
  double largest = 0;
  for (double y = 0; y <= height_m; y += 0.01)
    for (double x = 0; x <= width_m; x += 0.01) {
      Point u = Point::Zero();
      for (const Truth::Wave& w : out.waves) u += w.direction * std::sin(w.k.dot(Point(x, y)) + w.phase);
      largest = std::max(largest, u.norm());
    }
  out.gain = s.amplitude_m / largest;
  return out;
}

struct SlabSettings {
  double blur_mm = 2, noise = 0.03, faded_share = 0.3, fade_to = 0.3;
  int width = 600, height = 1200;
};
/// The slab that a graphic of this evidence produces under `truth`: warped, blurred, a band of it faded, noise added.
inline graphics::RasterF make_slab(const graphics::RasterF& print, const Truth& truth, const SlabSettings& s, std::uint64_t seed) {
  graphics::RasterF slab(s.width, s.height, 1, print.pitch_m);
  for (int j = 0; j < s.height; ++j)
    for (int i = 0; i < s.width; ++i) slab.at(i, j) = static_cast<float>(sample(print, truth(Point(i + 0.5, j + 0.5) * slab.pitch_m)));
  slab = blurred(slab, s.blur_mm);
  double mean = 0;
  for (const float v : slab.data) mean += static_cast<double>(v);
  mean /= static_cast<double>(slab.data.size());
  Rng rng(seed, stream_id("tests/sync/slab"));
  const double from = rng.uniform() * (1 - s.faded_share);
  const double background = mean < 0.5 ? 0 : mean;  // fraction fades to no vein, lightness to its mean
  for (int j = 0; j < s.height; ++j) {
    const double y = (j + 0.5) / s.height;
    const bool faded = y >= from && y < from + s.faded_share;
    for (int i = 0; i < s.width; ++i) {
      float& v = slab.at(i, j);
      if (faded) v = static_cast<float>(background + s.fade_to * (static_cast<double>(v) - background));
      v += static_cast<float>(s.noise * rng.normal());
    }
  }
  return slab;
}

/// |error| in mm of a found map on the slab's veins (plan > 0.5), every `step` pixels.
inline std::vector<double> errors_on_veins_mm(const Registration& r, const Truth& truth, const graphics::RasterF& plan_print, int width, int height,
                                              int step = 3) {
  std::vector<double> out;
  for (int j = 0; j < height; j += step)
    for (int i = 0; i < width; i += step) {
      const Point p = Point(i + 0.5, j + 0.5) * 0.001;
      const Point q = truth(p);
      if (q.x() < 0 || q.y() < 0 || q.x() > plan_print.width_m() || q.y() > plan_print.height_m()) continue;
      if (sample(plan_print, q) < 0.5) continue;
      out.push_back((r.print_from_green(p) - q).norm() * 1e3);
    }
  std::sort(out.begin(), out.end());
  return out;
}
inline double at_quantile(const std::vector<double>& sorted, double q) {
  return sorted.empty() ? NAN : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}
}  // namespace venato::sync::synthetic
