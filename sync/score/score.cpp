#include "sync/score/score.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include "base/error.h"
#include "sync/score/centreline.h"
#include "sync/score/distance.h"
#include "sync/score/shape.h"
namespace venato::sync {
namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Linear interpolation between order statistics (numpy's default).
double percentile(std::vector<double> v, double q) {
  if (v.empty()) return kNone;
  std::sort(v.begin(), v.end());
  const double at = q * static_cast<double>(v.size() - 1);
  const auto k = static_cast<std::size_t>(at);
  return k + 1 < v.size() ? v[k] + (at - static_cast<double>(k)) * (v[k + 1] - v[k]) : v[k];
}
double ratio(double a, double b) { return b > 0 ? a / b : 0; }  // 0/0 -> 0 (registration_print.md 2.1)

/// Distances [m] of the set pixels of `from` to the nearest set pixel of `to`; empty if either is empty.
std::vector<double> distances(const graphics::Raster8& from, const graphics::Raster8& to) {
  const graphics::RasterF d = distance_to(to);
  std::vector<double> out;
  for (std::size_t k = 0; k < from.data.size(); ++k)
    if (from.data[k] && std::isfinite(d.data[k])) out.push_back(static_cast<double>(d.data[k]) * from.pitch_m);
  return out;
}
double count(const graphics::Raster8& mask) {
  return static_cast<double>(std::count_if(mask.data.begin(), mask.data.end(), [](std::uint8_t v) { return v != 0; }));
}
double count_both(const graphics::Raster8& a, const graphics::Raster8& b) {
  double n = 0;
  for (std::size_t k = 0; k < a.data.size(); ++k) n += a.data[k] && b.data[k] ? 1 : 0;
  return n;
}

void boundary_metrics(const graphics::Raster8& body, const graphics::Raster8& print, Metrics& m) {
  const graphics::Raster8 edge_body = boundary(body), edge_print = boundary(print);
  const std::vector<double> there = distances(edge_body, edge_print), back = distances(edge_print, edge_body);
  const double n_body = count(edge_body), n_print = count(edge_print);
  const auto f1 = [&](double tolerance_m) {
    const auto near = [&](const std::vector<double>& d) {
      return static_cast<double>(std::count_if(d.begin(), d.end(), [&](double v) { return v <= tolerance_m * (1 + 1e-6); }));  // float distances
    };
    const double recall = ratio(near(there), n_body), precision = ratio(near(back), n_print);
    return ratio(2 * precision * recall, precision + recall);
  };
  m.boundary_f1_1mm = f1(0.001);
  m.boundary_f1_2mm = f1(0.002);
  m.boundary_f1_3mm = f1(0.003);
  double sum = 0;
  for (const double v : there) sum += v;
  for (const double v : back) sum += v;
  m.assd_m = there.empty() ? kNone : sum / static_cast<double>(there.size() + back.size());
  m.hd95_m = there.empty() ? kNone : std::max(percentile(there, 0.95), percentile(back, 0.95));
}

}  // namespace

void check_masks(const graphics::Raster8& body, const graphics::Raster8& print) {
  if (body.channels != 1 || print.channels != 1) throw UsageError("score: both masks must have 1 channel");
  if (body.width != print.width || body.height != print.height)
    throw UsageError("score: the masks differ in size: body " + std::to_string(body.width) + " x " + std::to_string(body.height) + ", print " +
                     std::to_string(print.width) + " x " + std::to_string(print.height));
  if (!(body.pitch_m > 0) || std::abs(body.pitch_m - print.pitch_m) > 1e-12) throw UsageError("score: both masks must have the same positive pitch");
}

Metrics score_masks(const graphics::Raster8& body, const graphics::Raster8& print, const ScoreConfig& config) {
  check_masks(body, print);
  Metrics m;
  const double both = count_both(body, print), n_body = count(body), n_print = count(print);
  m.dice = ratio(2 * both, n_body + n_print);
  m.iou = ratio(both, n_body + n_print - both);
  const graphics::Raster8 thin_body = zhang_suen(body), thin_print = zhang_suen(print);
  const double precision = ratio(count_both(thin_print, body), count(thin_print)),
               sensitivity = ratio(count_both(thin_body, print), count(thin_body));
  m.cl_dice = ratio(2 * precision * sensitivity, precision + sensitivity);
  boundary_metrics(body, print, m);

  const std::vector<CentreLink> body_links = centre_links(body, config.min_width_m), print_links = centre_links(print, config.min_width_m);
  double matched = 0, total = 0, signed_sum = 0, body_matched = 0;
  std::vector<std::pair<double, double>> residuals;
  // Lines thinner than min_width_m are not scored, but they are partners: a thin print line inside a wide body vein is no missing vein.
  for (const NormalResidual& r : normal_residuals(print_links, centre_links(body, 0), config)) {
    total += r.length_m;
    if (!r.matched) continue;
    matched += r.length_m;
    signed_sum += r.length_m * r.signed_distance_m;
    residuals.emplace_back(std::abs(r.signed_distance_m), r.length_m);
  }
  for (const NormalResidual& r : normal_residuals(body_links, centre_links(print, 0), config))
    (r.matched ? body_matched : m.missing_length_m) += r.length_m;
  m.body_length_m = body_matched + m.missing_length_m;
  m.print_length_m = total;
  m.matched_length = ratio(matched, total);
  m.extra_length_m = total - matched;
  m.centreline_median_m = weighted_quantile(residuals, 0.5);
  m.centreline_p95_m = weighted_quantile(residuals, 0.95);
  m.centreline_max_m = weighted_quantile(residuals, 1);
  m.centreline_offset_m = matched > 0 ? signed_sum / matched : kNone;
  m.area_error = n_body > 0 ? n_print / n_body - 1 : kNone;
  m.body_width_m = median_width_m(body_links);
  m.print_width_m = median_width_m(print_links);
  m.direction_coherence = direction_coherence(body, print);
  return m;
}

std::vector<ResidualSample> centreline_residuals(const graphics::Raster8& body, const graphics::Raster8& print, const ScoreConfig& config) {
  check_masks(body, print);
  std::vector<ResidualSample> out;
  for (const NormalResidual& r : normal_residuals(centre_links(print, config.min_width_m), centre_links(body, 0), config))
    out.push_back({r.at_m.x(), r.at_m.y(), r.signed_distance_m, r.matched});
  return out;
}

graphics::Raster8 mask_on_green(const graphics::RasterF& print_fraction, const Transform& print_from_green, int width, int height, double pitch_m,
                                float threshold) {
  if (print_fraction.channels != 1 || !(print_fraction.pitch_m > 0))
    throw UsageError("mask_on_green: the print must have 1 channel and a positive pitch");
  if (width < 0 || height < 0 || !(pitch_m > 0)) throw UsageError("mask_on_green: the green grid must have a size and a positive pitch");
  graphics::Raster8 out(width, height, 1, pitch_m);
  const int w = print_fraction.width, h = print_fraction.height;
  if (w == 0 || h == 0) return out;
  std::vector<double> ux(static_cast<std::size_t>(width)), uy(ux.size());
  for (int j = 0; j < height; ++j) {
    const double y = (j + 0.5) * pitch_m;
    displacement_row(print_from_green.u, y, 0.5 * pitch_m, pitch_m, width, ux.data(), uy.data());
    for (int i = 0; i < width; ++i) {
      const Point moved((i + 0.5) * pitch_m + ux[static_cast<std::size_t>(i)], y + uy[static_cast<std::size_t>(i)]);
      const Point q = (print_from_green.a * moved + print_from_green.t) / print_fraction.pitch_m - Point(0.5, 0.5);
      if (!(q.x() >= -0.5 && q.y() >= -0.5 && q.x() <= w - 0.5 && q.y() <= h - 0.5)) continue;
      const double x = std::clamp(q.x(), 0.0, w - 1.0), z = std::clamp(q.y(), 0.0, h - 1.0);
      const int a = static_cast<int>(x), b = static_cast<int>(z), a1 = std::min(a + 1, w - 1), b1 = std::min(b + 1, h - 1);
      const auto fx = static_cast<float>(x - a), fz = static_cast<float>(z - b);
      const float v = (1 - fz) * ((1 - fx) * print_fraction.at(a, b) + fx * print_fraction.at(a1, b)) +
                      fz * ((1 - fx) * print_fraction.at(a, b1) + fx * print_fraction.at(a1, b1));
      if (v > threshold) out.at(i, j) = 255;  // false for NaN
    }
  }
  return out;
}
}  // namespace venato::sync
