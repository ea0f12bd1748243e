#include "sync/score/visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "graphics/seen/scielab.h"
#include "sync/score/centreline.h"
#include "sync/score/sample.h"
namespace venato::sync {
namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kStep_px = 0.5;    // along the normal
constexpr double kMargin_px = 1.0;  // beyond the vein's edge: where the blur has put an edge's difference

graphics::RasterF painted(const graphics::Raster8& mask, const PrintColours& colours) {
  const graphics::Xyz on = graphics::xyz_from_srgb(colours.vein), off = graphics::xyz_from_srgb(colours.ground);
  const float vein[3] = {static_cast<float>(on.x), static_cast<float>(on.y), static_cast<float>(on.z)},
              ground[3] = {static_cast<float>(off.x), static_cast<float>(off.y), static_cast<float>(off.z)};
  graphics::RasterF out(mask.width, mask.height, 3, mask.pitch_m);
  for (std::size_t k = 0; k < mask.data.size(); ++k)
    std::copy_n(mask.data[k] ? vein : ground, 3, out.data.begin() + static_cast<std::ptrdiff_t>(3 * k));
  return out;
}

/// Largest difference across a vein whose middle the sample is, and across the place where it should be.
double seen_across(const graphics::RasterF& delta_e, const NormalResidual& r) {
  const double aside = r.matched ? r.signed_distance_m / delta_e.pitch_m : 0, half = r.width_m / delta_e.pitch_m / 2 + kMargin_px;
  const Point middle = r.at_m / delta_e.pitch_m - Point(0.5, 0.5);
  double most = 0;
  for (double t = std::min(0.0, aside) - half; t <= std::max(0.0, aside) + half; t += kStep_px)
    most = std::max(most, bilinear(delta_e, middle + t * r.normal));
  return most;
}

void measure_area(Visibility& v, const graphics::Raster8& body, const graphics::Raster8& print) {
  std::vector<float> covered;
  double sum = 0;
  std::size_t over_1 = 0, over_2 = 0;
  for (std::size_t k = 0; k < body.data.size(); ++k) {
    const float d = v.delta_e.data[k];
    over_1 += d > 1, over_2 += d > 2;
    if (!body.data[k] && !print.data[k]) continue;
    covered.push_back(d);
    sum += static_cast<double>(d);
  }
  const auto share = [&](std::size_t n) { return body.data.empty() ? 0 : static_cast<double>(n) / static_cast<double>(body.data.size()); };
  v.area_over_1 = share(over_1), v.area_over_2 = share(over_2);
  v.delta_e_mean = covered.empty() ? kNone : sum / static_cast<double>(covered.size());
  if (covered.empty()) {
    v.delta_e_p95 = kNone;
    return;
  }
  const auto at = covered.begin() + static_cast<std::ptrdiff_t>(std::ceil(0.95 * static_cast<double>(covered.size()))) - 1;
  std::nth_element(covered.begin(), at, covered.end());
  v.delta_e_p95 = static_cast<double>(*at);
}
}  // namespace

std::optional<PrintColours> print_colours(const graphics::Raster8& picture, const graphics::RasterF& vein_fraction) {
  VENATO_EXPECTS(picture.channels == 1 || picture.channels == 3);
  if (picture.empty() || vein_fraction.empty()) return std::nullopt;
  std::array<std::array<double, 3>, 2> light{};
  std::array<double, 2> pixels{};
  const double scale = picture.pitch_m / vein_fraction.pitch_m;
  for (int j = 0; j < picture.height; ++j)
    for (int i = 0; i < picture.width; ++i) {
      const float f = vein_fraction.at(std::min(vein_fraction.width - 1, static_cast<int>((i + 0.5) * scale)),
                                       std::min(vein_fraction.height - 1, static_cast<int>((j + 0.5) * scale)));
      if (std::isnan(f)) continue;
      const std::size_t side = f >= 0.5f ? 0 : 1;
      for (int c = 0; c < 3; ++c)
        light[side][static_cast<std::size_t>(c)] += graphics::srgb_to_linear(picture.at(i, j, picture.channels == 3 ? c : 0));
      ++pixels[side];
    }
  if (!(pixels[0] > 0 && pixels[1] > 0)) return std::nullopt;
  const auto mean = [&](std::size_t side) {
    graphics::Srgb8 out{};
    for (std::size_t c = 0; c < 3; ++c) out[c] = graphics::linear_to_srgb(light[side][c] / pixels[side]);
    return out;
  };
  PrintColours out{mean(0), mean(1), 0};
  out.delta_e = graphics::delta_e2000(graphics::lab_from_srgb(out.vein), graphics::lab_from_srgb(out.ground));
  return out;
}

std::vector<std::vector<Visibility>> visibility(const graphics::Raster8& body, const std::vector<const graphics::Raster8*>& prints,
                                                const PrintColours& colours, int threads, const VisibilityConfig& config, const ScoreConfig& score) {
  for (const double d : config.distances_m)
    if (!(d > 0) || !std::isfinite(d)) throw UsageError("visibility: a viewing distance of " + std::to_string(d) + " m is not positive and finite");
  // As in score_masks(): lines thinner than min_width_m are not scored, but they are partners.
  const std::vector<CentreLink> body_lines = centre_links(body, score.min_width_m), body_partners = centre_links(body, 0);
  const graphics::RasterF aligned = painted(body, colours);
  std::vector<graphics::RasterF> as_aligned;
  for (const double d : config.distances_m) as_aligned.push_back(graphics::lab_seen_from(aligned, d, threads));
  std::vector<std::vector<Visibility>> out;
  for (const graphics::Raster8* print : prints) {
    check_masks(body, *print);
    const auto print_samples = normal_residuals(centre_links(*print, score.min_width_m), body_partners, score);
    const auto body_samples = normal_residuals(body_lines, centre_links(*print, 0), score);
    const graphics::RasterF as_is = painted(*print, colours);
    std::vector<Visibility>& seen = out.emplace_back();
    for (std::size_t k = 0; k < config.distances_m.size(); ++k) {
      Visibility& v = seen.emplace_back();
      v.distance_m = config.distances_m[k];
      v.delta_e = graphics::delta_e2000(as_aligned[k], graphics::lab_seen_from(as_is, v.distance_m, threads), threads);
      measure_area(v, body, *print);
      for (const NormalResidual& r : print_samples) {
        v.print_length_m += r.length_m;
        if (r.matched && std::abs(r.signed_distance_m) <= config.resolved_rad * v.distance_m) continue;
        if (seen_across(v.delta_e, r) > config.noticeable_delta_e) (r.matched ? v.displaced_length_m : v.extra_length_m) += r.length_m;
      }
      for (const NormalResidual& r : body_samples)
        if (!r.matched && seen_across(v.delta_e, r) > config.noticeable_delta_e) v.missing_length_m += r.length_m;
    }
  }
  return out;
}

VisibilityReport visibility_report(const graphics::Raster8& body, const graphics::Raster8& before, const graphics::Raster8* after,
                                   const PrintColours& colours, int threads, const VisibilityConfig& config, const ScoreConfig& score) {
  std::vector<const graphics::Raster8*> prints = {&before};
  if (after) prints.push_back(after);
  auto seen = visibility(body, prints, colours, threads, config, score);
  VisibilityReport out{colours, config.noticeable_delta_e, std::move(seen[0]), {}};
  if (!after) return out;
  out.after = std::move(seen[1]);
  for (Visibility& v : out.before) v.delta_e = {};
  return out;
}
}  // namespace venato::sync
