#include <Eigen/LU>
#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include "tests/bench/registration/cases.h"
namespace venato::bench {
using graphics::RasterF;
using sync::Point;
namespace s = sync::synthetic;
namespace {
constexpr double kMargin_m = 0.050;  // the scene reaches that far beyond the slab on every side

/// 0..1, most of it near 0 or 1; 0 on about `share` of the raster. Patches of some 150 mm.
RasterF patches(int width, int height, double share, Rng& rng) {
  s::Truth waves;
  std::vector<s::Truth::Wave> all;
  for (int k = 0; k < 12; ++k) {
    const double length = 0.25 + 0.5 * rng.uniform(), heading = 2 * M_PI * rng.uniform();
    all.push_back({2 * M_PI / length * Point(std::cos(heading), std::sin(heading)), Point::Zero(), 2 * M_PI * rng.uniform()});
  }
  constexpr int kStep = 8;  // mm; interpolated below
  RasterF coarse(width / kStep + 2, height / kStep + 2, 1, 0.001 * kStep);
  for (int j = 0; j < coarse.height; ++j)
    for (int i = 0; i < coarse.width; ++i) {
      double v = 0;
      for (const auto& w : all) v += std::sin(w.k.dot(Point(i, j) * coarse.pitch_m) + w.phase);
      coarse.at(i, j) = static_cast<float>(v);
    }
  std::vector<float> sorted = coarse.data;
  std::sort(sorted.begin(), sorted.end());
  const double level = static_cast<double>(sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]);
  RasterF out(width, height, 1, 0.001);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      out.at(i, j) = static_cast<float>(std::clamp((s::sample(coarse, Point(i + 0.5, j + 0.5) * 0.001) - level) / 0.3 + 0.5, 0.0, 1.0));
  return out;
}
}  // namespace

Scene load_scene(const std::string& file) {
  const cv::Mat image = cv::imread(file, cv::IMREAD_COLOR);
  if (image.empty()) throw std::runtime_error("cannot read the scene " + file);
  Scene out;
  out.name = file.substr(file.find_last_of('/') + 1);
  out.luma = out.other = RasterF(image.cols, image.rows, 1, 0.001);
  for (int j = 0; j < image.rows; ++j)
    for (int i = 0; i < image.cols; ++i) {
      const auto c = image.at<cv::Vec3b>(j, i);
      out.luma.at(i, j) = (0.114f * c[0] + 0.587f * c[1] + 0.299f * c[2]) / 255.0f;
      out.other.at(i, j) = (0.5f * c[0] + 0.1f * c[1] + 0.4f * c[2]) / 255.0f;
    }
  RasterF tone = out.luma;
  if (out.name.find("dark") != std::string::npos)
    for (float& v : tone.data) v = 1 - v;
  out.plan = s::vein_plan(tone);
  return out;
}

Pair make_pair(const Scene& scene, const PairSettings& p, std::uint64_t seed) {
  Rng rng(seed, stream_id("tests/bench/registration"));
  Pair out;
  out.kind = p.picture ? sync::EvidenceKind::picture : sync::EvidenceKind::vein_fraction;
  out.print = p.picture ? scene.luma : scene.plan;
  out.veins = scene.plan;
  const int width = p.portion ? 800 : 1600, height = p.portion ? 1600 : 3200;
  const Point room(scene.luma.width_m() - width * 1e-3 - 2 * kMargin_m, scene.luma.height_m() - height * 1e-3 - 2 * kMargin_m);
  const Point at = Point(kMargin_m, kMargin_m) + Point(std::max(0.0, room.x()) * rng.uniform(), std::max(0.0, room.y()) * rng.uniform());
  s::WarpSettings warp;
  warp.rotation_rad = (2 * rng.uniform() - 1) * M_PI / 180;
  warp.stretch_x = 1 + 0.01 * (2 * rng.uniform() - 1);
  warp.stretch_y = warp.stretch_x + 0.006 * (2 * rng.uniform() - 1);  // the belt stretches along y only
  warp.amplitude_m = p.amplitude_m;
  warp.shift_m = at + Point(2 * rng.uniform() - 1, 2 * rng.uniform() - 1) * 0.015;
  out.truth = s::make_truth(warp, width * 1e-3, height * 1e-3, seed);

  RasterF slab(width, height, 1, 0.001), background = slab;
  const RasterF& source = p.inverted ? scene.other : p.picture ? scene.luma : scene.plan;
  const RasterF body = p.picture ? s::blurred(source, 60) : RasterF(source.width, source.height, 1, 0.001);  // no vein: 0, or what is around it
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const Point q = out.truth(Point(i + 0.5, j + 0.5) * 0.001);
      slab.at(i, j) = static_cast<float>(s::sample(source, q));
      const int x = std::clamp(static_cast<int>(q.x() * 1e3), 0, body.width - 1), y = std::clamp(static_cast<int>(q.y() * 1e3), 0, body.height - 1);
      background.at(i, j) = body.at(x, y);
    }
  if (p.missing > 0) {
    out.kept = patches(width, height, p.missing, rng);
    for (std::size_t k = 0; k < slab.data.size(); ++k)
      slab.data[k] = background.data[k] + out.kept.data[k] * (slab.data[k] - background.data[k]);
  }
  slab = s::blurred(slab, p.blur_mm);
  const double from = rng.uniform() * (1 - p.faded);
  out.faded_from_m = from * height * 1e-3, out.faded_to_m = (from + p.faded) * height * 1e-3;
  for (int j = 0; j < height; ++j) {
    const double y = (j + 0.5) / height;
    const float keep = y >= from && y < from + p.faded ? 0.2f : 1.0f;
    for (int i = 0; i < width; ++i) {
      float& v = slab.at(i, j);
      v = background.at(i, j) + keep * (v - background.at(i, j));
      if (p.inverted) v = 0.85f - 0.7f * std::pow(std::max(0.0f, v), 0.8f);
      if (p.picture) v *= static_cast<float>(1 + 0.15 * std::sin(2.1 * y + 1.3 * i / width));  // uneven light
      v += static_cast<float>(p.noise * (p.picture ? 0.7 : 1.0) * rng.normal());
    }
  }
  out.green = std::move(slab);
  return out;
}

sync::Transform make_prior(const Pair& pair, double error_m, std::uint64_t seed) {
  const double width = pair.green.width_m(), height = pair.green.height_m();
  Rng rng(seed, stream_id("tests/bench/registration/prior"));
  std::vector<s::Truth::Wave> waves;
  for (int k = 0; k < 6; ++k) {
    const double length = 0.6 + 0.6 * rng.uniform(), heading = 2 * M_PI * rng.uniform(), sense = 2 * M_PI * rng.uniform();
    waves.push_back(
        {2 * M_PI / length * Point(std::cos(heading), std::sin(heading)), Point(std::cos(sense), std::sin(sense)), 2 * M_PI * rng.uniform()});
  }
  const auto wave_sum = [&](const Point& p) {
    Point u = Point::Zero();
    for (const auto& w : waves) u += w.direction * std::sin(w.k.dot(p) + w.phase);
    return u;
  };
  double largest = 0;
  for (double y = 0; y <= height; y += 0.01)
    for (double x = 0; x <= width; x += 0.01) largest = std::max(largest, wave_sum({x, y}).norm());
  sync::Transform out;
  out.a = pair.truth.a;
  out.t = pair.truth.t + Point(0.0014, -0.0014);
  out.u = sync::make_zero_field(width, height, 0.025);
  const auto wanted = [&](int i, int j) -> Point {
    const Point p = out.u.origin_m + out.u.spacing_m * Point(i - 1, j - 1);
    return pair.truth.a.inverse() * (pair.truth(p) - pair.truth.t) - p + error_m / largest * wave_sum(p);
  };
  // Cubic quasi-interpolation (-1, 8, -1) / 6 each way: on waves of ten spacings and more exact to 1e-3 of their height.
  constexpr double kWeight[] = {-1.0 / 6, 8.0 / 6, -1.0 / 6};
  for (int j = 0; j < out.u.ny; ++j)
    for (int i = 0; i < out.u.nx; ++i) {
      Point c = Point::Zero();
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) c += kWeight[di + 1] * kWeight[dj + 1] * wanted(i + di, j + dj);
      const auto k = static_cast<std::size_t>(j) * static_cast<std::size_t>(out.u.nx) + static_cast<std::size_t>(i);
      out.u.cx[k] = c.x(), out.u.cy[k] = c.y();
    }
  return out;
}
std::vector<PairSettings> judged_settings(int count) {
  const std::vector<PairSettings> kinds = {{"plain 10 mm"},
                                           {"faded quarter 10 mm", 0.010, 0, 0.25},
                                           {"missing 15 %", 0.010, 0.15},
                                           {"picture 5 mm", 0.005, 0, 0, 1, 0.02, true},
                                           {"portion 5 mm", 0.005, 0, 0, 2, 0.03, false, false, true},
                                           {"plain 10 mm"},
                                           {"faded quarter 10 mm", 0.010, 0, 0.25},
                                           {"missing 30 %", 0.010, 0.30},
                                           {"inverted, other colours 5 mm", 0.005, 0, 0, 1, 0.02, true, true},
                                           {"blur 5 mm, noise 8 %", 0.005, 0, 0, 5, 0.08}};
  std::vector<PairSettings> out;
  for (int k = 0; k < count; ++k) out.push_back(kinds[static_cast<std::size_t>(k) % kinds.size()]);
  return out;
}
}  // namespace venato::bench
