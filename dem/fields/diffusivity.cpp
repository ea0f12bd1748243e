#include "dem/fields/diffusivity.h"

#include <cmath>
#include <numeric>

namespace venato::dem {
namespace {
constexpr double kPlateauBand = 0.05;  // multiscale.md 1.4
}

double DiffusivitySums::mean_trace() const {
  const auto sum = [](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
  const double w = sum(weight);
  return w > 0 ? (sum(xx) + sum(yy) + sum(zz)) / w / 3 : std::nan("");
}

DiffusivitySums diffusivity_sums(const Tracks& tracks, const IntegratedFlow& flow, std::span<const double> times_s,
                                 std::span<const double> frame_weights, const MeanFlow& mean, const FieldGrid& grid, bool periodic_y,
                                 std::size_t lag) {
  const GridLookup lookup(grid, periodic_y);
  DiffusivitySums sums;
  for (auto* v : {&sums.weight, &sums.xx, &sums.yy, &sums.zz, &sums.yz}) v->assign(grid.size(), 0);
  for (std::size_t p = 0; p < tracks.count(); ++p)
    for (std::size_t e = tracks.start[p]; e + lag < tracks.start[p + 1]; ++e) {
      if (flow.unknown[e + lag] != flow.unknown[e]) continue;
      const std::size_t f = static_cast<std::size_t>(tracks.first_frame[p]) + e - tracks.start[p];
      const double w = tracks.volume_m3[p] * frame_weights[f];
      if (!(w > 0)) continue;
      const Vec3& from = tracks.position_m[e];
      const Vec3& to = tracks.position_m[e + lag];
      const auto c = lookup.cell(0.5 * (from.y() + to.y()), 0.5 * (from.z() + to.z()));
      if (!c || !mean.known(*c)) continue;
      const Vec3 xi = to - from - (flow.displacement_m[e + lag] - flow.displacement_m[e]);
      const double scale = w / (2 * (times_s[f + lag] - times_s[f]));
      sums.weight[*c] += w;
      sums.xx[*c] += scale * xi.x() * xi.x();
      sums.yy[*c] += scale * xi.y() * xi.y();
      sums.zz[*c] += scale * xi.z() * xi.z();
      sums.yz[*c] += scale * xi.y() * xi.z();
    }
  return sums;
}

std::vector<std::size_t> candidate_lags(std::size_t max_lag_frames) {
  std::vector<std::size_t> lags;
  for (std::size_t base = 1; base <= max_lag_frames; base *= 2) {
    lags.push_back(base);
    if (base > 1 && base + base / 2 <= max_lag_frames) lags.push_back(base + base / 2);
  }
  return lags;
}

std::size_t smallest_plateau_lag(std::span<const std::size_t> lags, std::span<const double> traces) {
  double plateau = 0;
  int n = 0;
  for (std::size_t k = 0; k < lags.size(); ++k)
    if (2 * lags[k] >= lags.back() && std::isfinite(traces[k])) plateau += traces[k], ++n;
  if (n == 0) return lags.size() - 1;
  plateau /= n;
  for (std::size_t k = 0; k < lags.size(); ++k)
    if (std::abs(traces[k] - plateau) <= kPlateauBand * plateau) return k;
  return lags.size() - 1;
}
}  // namespace venato::dem
