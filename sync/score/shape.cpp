#include "sync/score/shape.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include "graphics/raster/mask.h"
#include "sync/score/sample.h"
namespace venato::sync {
namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kDerivativeScale_m = 0.001, kTensorScale_m = 0.003;
constexpr double kStep_px = 0.25;
constexpr double kRise = 0.05;  // of the vein's value: more than speckle of a powder map after its own blur

struct Tensor {
  graphics::RasterF xx, xy, yy;
};
Tensor structure_tensor(const graphics::Raster8& mask) {
  graphics::RasterF f(mask.width, mask.height, 1, mask.pitch_m);
  for (std::size_t k = 0; k < f.data.size(); ++k) f.data[k] = mask.data[k] ? 1.0f : 0.0f;
  f = graphics::gaussian(f, kDerivativeScale_m / mask.pitch_m);
  Tensor t{f, f, f};
  for (int j = 0; j < f.height; ++j)
    for (int i = 0; i < f.width; ++i) {
      const float dx = f.at(std::min(i + 1, f.width - 1), j) - f.at(std::max(i - 1, 0), j),
                  dy = f.at(i, std::min(j + 1, f.height - 1)) - f.at(i, std::max(j - 1, 0));
      t.xx.at(i, j) = dx * dx;
      t.xy.at(i, j) = dx * dy;
      t.yy.at(i, j) = dy * dy;
    }
  const double sigma = kTensorScale_m / mask.pitch_m;
  return {graphics::gaussian(t.xx, sigma), graphics::gaussian(t.xy, sigma), graphics::gaussian(t.yy, sigma)};
}

/// \return width of the edge [px], NaN when it has no clean end
double edge_width_px(const graphics::RasterF& f, Point centre_px, Point normal, double reach_px) {
  const double top = bilinear(f, centre_px);
  if (!(top > 0)) return kNone;
  double before = top, lowest = top, r90 = 0;
  for (double r = kStep_px; r <= reach_px; r += kStep_px) {
    const double v = bilinear(f, centre_px + r * normal);
    if (!std::isfinite(v) || v > lowest + kRise * top) {
      // Still on the plateau: a rise there only moves the top of the edge outwards.
      if (!std::isfinite(v) || lowest < 0.9 * top) return kNone;
    }
    const auto crossing = [&](double level) { return r - kStep_px * (level - v) / (before - v); };
    if (before >= 0.9 * top && v < 0.9 * top) r90 = crossing(0.9 * top);
    if (v < 0.1 * top) return crossing(0.1 * top) - r90;
    lowest = std::min(lowest, v);
    before = v;
  }
  return kNone;
}
}  // namespace

double weighted_quantile(std::vector<std::pair<double, double>> value_weight, double q) {
  if (value_weight.empty()) return kNone;
  std::sort(value_weight.begin(), value_weight.end());
  double total = 0;
  for (const auto& v : value_weight) total += v.second;
  double sum = 0;
  for (const auto& v : value_weight) {
    sum += v.second;
    if (sum >= q * total) return v.first;
  }
  return value_weight.back().first;
}

double median_width_m(const std::vector<CentreLink>& links) {
  std::vector<std::pair<double, double>> widths;
  for (const CentreLink& l : links) widths.emplace_back(l.width_m, l.length_m);
  return weighted_quantile(std::move(widths), 0.5);
}

double direction_coherence(const graphics::Raster8& body, const graphics::Raster8& print) {
  if (body.empty()) return kNone;
  const Tensor a = structure_tensor(body), b = structure_tensor(print);
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < body.data.size(); ++k) {
    if (!body.data[k] || !print.data[k]) continue;
    // (c, s) = coherence times cosine and sine of twice the direction, so the scalar product is both weights times cos 2(difference).
    double c[2], s[2], coherence[2];
    for (int side = 0; side < 2; ++side) {
      const Tensor& t = side ? b : a;
      const double xx = static_cast<double>(t.xx.data[k]), xy = static_cast<double>(t.xy.data[k]), yy = static_cast<double>(t.yy.data[k]);
      const double trace = xx + yy;
      c[side] = trace > 1e-9 ? (xx - yy) / trace : 0;
      s[side] = trace > 1e-9 ? 2 * xy / trace : 0;
      coherence[side] = std::hypot(c[side], s[side]);
    }
    sum += c[0] * c[1] + s[0] * s[1];
    weights += coherence[0] * coherence[1];
  }
  return weights > 0 ? sum / weights : kNone;
}

EdgeWidths edge_widths(const graphics::RasterF& fraction, const std::vector<CentreLink>& links, double reach_m) {
  EdgeWidths out{kNone, kNone, 0};
  if (fraction.empty()) return out;
  std::vector<std::pair<double, double>> found;
  double total = 0, measured = 0;
  for (const CentreLink& l : links) {
    const Point step = l.to_m - l.from_m;
    if (!(step.norm() > 0)) continue;
    const Point normal = Point(-step.y(), step.x()).normalized();
    const Point centre = (l.from_m + l.to_m) / 2 / fraction.pitch_m - Point(0.5, 0.5);
    for (const double side : {-1.0, 1.0}) {
      const double width = edge_width_px(fraction, centre, side * normal, reach_m / fraction.pitch_m);
      total += l.length_m;
      if (!std::isfinite(width)) continue;
      measured += l.length_m;
      found.emplace_back(width * fraction.pitch_m, l.length_m);
    }
  }
  out.measured = total > 0 ? measured / total : 0;
  out.median_m = weighted_quantile(found, 0.5);
  out.p95_m = weighted_quantile(found, 0.95);
  return out;
}
}  // namespace venato::sync
