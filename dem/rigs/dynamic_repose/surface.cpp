#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/rigs/dynamic_repose/rig.h"
#include "dem/rigs/support/statistics.h"

namespace venato::dem::rigs::dynamic_repose {
namespace {
constexpr double kFullQuantile = 0.6;  // of the cells that hold anything: inside the filling, below the surface layer
}

Surface free_surface(const std::vector<const Snapshot*>& frames, const Config& config, double grain) {
  const int horizontal = config.axis == 0 ? 1 : 0;
  const auto n = static_cast<std::size_t>(std::ceil(2 * config.radius_m / grain));
  const double cell = 2 * config.radius_m / static_cast<double>(n), low = -config.radius_m;
  std::vector<double> volume(n * n, 0);  // [column][row]
  for (const Snapshot* s : frames)
    for (std::size_t k = 0; k < s->id.size(); ++k) {
      const double u = s->position_m[k][horizontal] - config.centre_m[0] - low, z = s->position_m[k].z() - config.centre_m[1] - low;
      if (!(u >= 0 && z >= 0 && u < 2 * config.radius_m && z < 2 * config.radius_m)) continue;
      volume[std::min(n - 1, static_cast<std::size_t>(u / cell)) * n + std::min(n - 1, static_cast<std::size_t>(z / cell))] +=
          std::pow(static_cast<double>(s->radius_m[k]), 3);
    }
  std::vector<double> filled;
  for (const double v : volume)
    if (v > 0) filled.push_back(v);
  Surface out;
  if (filled.empty()) return out;
  std::nth_element(filled.begin(), filled.begin() + static_cast<std::ptrdiff_t>(kFullQuantile * static_cast<double>(filled.size())), filled.end());
  const double half = 0.5 * filled[static_cast<std::size_t>(kFullQuantile * static_cast<double>(filled.size()))];
  for (std::size_t i = 0; i < n; ++i) {
    double height = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t j = n; j-- > 0;) {
      const double here = volume[i * n + j];
      if (here < half) continue;
      const double above = j + 1 < n ? volume[i * n + j + 1] : 0;
      height = low + cell * (static_cast<double>(j) + 0.5 + (here - half) / (here - above));
      break;
    }
    out.across_m.push_back(low + cell * (static_cast<double>(i) + 0.5));
    out.height_m.push_back(height);
  }
  return out;
}

double surface_angle_deg(const Surface& s, const Config& config, double* rms) {
  std::vector<double> x, y;
  for (std::size_t k = 0; k < s.across_m.size(); ++k)
    if (std::abs(s.across_m[k]) <= config.central * config.radius_m && !std::isnan(s.height_m[k]))
      x.push_back(s.across_m[k]), y.push_back(s.height_m[k]);
  if (rms) *rms = std::numeric_limits<double>::quiet_NaN();
  if (x.size() < 4) return std::numeric_limits<double>::quiet_NaN();
  const LineFit fit = fit_line(x, y);
  if (rms) *rms = fit.rms;
  return std::atan(fit.slope) * 180 / std::numbers::pi;
}
}  // namespace venato::dem::rigs::dynamic_repose
