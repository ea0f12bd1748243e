#include "sync/command/noise_floor.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace venato::sync {
namespace {

constexpr double kSpacing_m = 0.120;   // correlation length of the trials of registration_print.md 1.4
constexpr double kLeastRms_m = 0.001;  // a slab that needed no displacement is still tried with 1 mm
constexpr double kMostRms_m = 0.008;   // beyond, random maps of this spacing start to fold
constexpr double kSampleStep_m = 0.020;

double rms_displacement_m(const BSplineField& u, double width_m, double height_m) {
  if (u.spacing_m <= 0) return 0;
  double sum = 0;
  int n = 0;
  for (double y = 0; y <= height_m; y += kSampleStep_m)
    for (double x = 0; x <= width_m; x += kSampleStep_m, ++n) sum += u.displacement(Point(x, y)).squaredNorm();
  return n ? std::sqrt(sum / n) : 0;
}

/// green_from_copy: the inverse of the found pose, and a random field in the copy's (print) frame.
Transform random_map(const Registration& found, double copy_width_m, double copy_height_m, double rms_m, std::uint64_t seed) {
  Transform map;
  map.a = found.pose_only.a.inverse();
  map.t = -map.a * found.pose_only.t;
  map.u = make_zero_field(copy_width_m, copy_height_m, kSpacing_m);
  Rng rng(seed, stream_id("sync/noise_floor"));
  for (auto* c : {&map.u.cx, &map.u.cy})
    for (double& v : *c) v = rng.normal();
  const double scale = rms_m / std::max(rms_displacement_m(map.u, copy_width_m, copy_height_m), 1e-12);
  for (auto* c : {&map.u.cx, &map.u.cy})
    for (double& v : *c) v *= scale;
  return map;
}

/// source(map(q)) on a grid; `valid` is 0 outside the source.
graphics::RasterF resampled(const graphics::RasterF& source, const Transform& map, int width, int height, double pitch_m, graphics::Raster8& valid) {
  graphics::RasterF out(width, height, 1, pitch_m);
  valid = graphics::Raster8(width, height, 1, pitch_m);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const Point p = map(Point((i + 0.5) * pitch_m, (j + 0.5) * pitch_m)) / source.pitch_m;
      const double x = p.x() - 0.5, y = p.y() - 0.5;
      if (!(x >= 0 && y >= 0 && x <= source.width - 1 && y <= source.height - 1)) continue;
      const int i0 = std::min(static_cast<int>(x), source.width - 2), j0 = std::min(static_cast<int>(y), source.height - 2);
      const double fx = x - i0, fy = y - j0;
      out.at(i, j) = static_cast<float>((1 - fy) * ((1 - fx) * source.at(i0, j0) + fx * source.at(i0 + 1, j0)) +
                                        fy * ((1 - fx) * source.at(i0, j0 + 1) + fx * source.at(i0 + 1, j0 + 1)));
      valid.at(i, j) = 255;
    }
  return out;
}

/// Pixels whose four neighbours were not all seen are not seen.
void keep_seen(graphics::Raster8& valid, const graphics::Raster8& seen, const Transform& map) {
  if (seen.empty()) return;
  for (int j = 0; j < valid.height; ++j)
    for (int i = 0; i < valid.width; ++i) {
      if (!valid.at(i, j)) continue;
      const Point p = map(Point((i + 0.5) * valid.pitch_m, (j + 0.5) * valid.pitch_m)) / seen.pitch_m;
      const int i0 = std::min(static_cast<int>(p.x() - 0.5), seen.width - 2), j0 = std::min(static_cast<int>(p.y() - 0.5), seen.height - 2);
      if (!seen.at(i0, j0) || !seen.at(i0 + 1, j0) || !seen.at(i0, j0 + 1) || !seen.at(i0 + 1, j0 + 1)) valid.at(i, j) = 0;
    }
}

}  // namespace

std::optional<Metrics> noise_floor(const EvidencePair& evidence, const graphics::RasterF& body_fraction, const Registration& found,
                                   const RegistrationConfig& config, const ScoreConfig& score, Context& context) {
  const graphics::RasterF& frame = evidence.print.value;
  if (body_fraction.width < 2 || body_fraction.height < 2 || !(std::abs(found.pose_only.a.determinant()) > 1e-9)) return std::nullopt;
  const double rms =
      std::clamp(rms_displacement_m(found.print_from_green.u, body_fraction.width_m(), body_fraction.height_m()), kLeastRms_m, kMostRms_m);
  const Transform green_from_copy = random_map(found, frame.width_m(), frame.height_m(), rms, context.seed);
  graphics::Raster8 valid;
  const graphics::RasterF copy_fraction = resampled(body_fraction, green_from_copy, frame.width, frame.height, frame.pitch_m, valid);
  Evidence copy;
  copy.kind = evidence.green.kind;
  copy.value = resampled(evidence.green.value, green_from_copy, frame.width, frame.height, frame.pitch_m, copy.valid);
  keep_seen(copy.valid, evidence.green.valid, green_from_copy);
  const Registration back = register_veins(evidence.green, copy, config, std::nullopt, context);
  if (!back.success) return std::nullopt;
  graphics::Raster8 print = mask_on_green(copy_fraction, back.print_from_green, body_fraction.width, body_fraction.height, body_fraction.pitch_m);
  keep_valid(print, evidence.green.valid);
  return score_masks(vein_mask(body_fraction), print, score);
}

}  // namespace venato::sync
