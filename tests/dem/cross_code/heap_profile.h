#pragma once
/// Surface of a heap and its flank angle, as the peer runs were read: annuli of 1 mm x 36 sectors about the heap's axis, highest grain top per cell,
/// mean over sectors; straight line through 15 … 80 % of the apex height.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "dem/simulation/simulation.h"

namespace venato::dem::peers {

struct HeapProfile {
  std::vector<double> radius_m, height_m;                                  ///< NaN where too few sectors hold grains
  double apex_m = 0, flank_deg = 0, flank_sd_deg = 0, mean_speed_m_s = 0;  ///< sd over six wedges of 60 degrees
};

/// Slope of y over x by least squares.
inline double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) sx += x[k], sy += y[k], sxx += x[k] * x[k], sxy += x[k] * y[k];
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

inline HeapProfile heap_profile(std::span<const GrainState> grains, double diameter_m = 1e-3) {
  constexpr std::size_t kBins = 40, kSectors = 36;
  const double bin = diameter_m, nan = std::numeric_limits<double>::quiet_NaN();
  HeapProfile p;
  double cx = 0, cy = 0, n = 0;
  for (const GrainState& g : grains) {
    p.mean_speed_m_s += g.velocity_m_s.norm() / static_cast<double>(grains.size());
    if (g.position_m.z() > 1.5 * diameter_m) cx += g.position_m.x(), cy += g.position_m.y(), n += 1;
  }
  cx /= n, cy /= n;
  std::vector<std::array<double, kSectors>> top(kBins);
  for (auto& row : top) row.fill(nan);
  for (const GrainState& g : grains) {
    const double x = g.position_m.x() - cx, y = g.position_m.y() - cy;
    const auto b = static_cast<std::size_t>(std::hypot(x, y) / bin);
    const auto s = static_cast<std::size_t>((std::atan2(y, x) + std::numbers::pi) / (2 * std::numbers::pi) * kSectors) % kSectors;
    const double t = g.position_m.z() + g.radius_m;
    if (b < kBins && !(top[b][s] >= t)) top[b][s] = t;
  }
  const auto mean = [&](std::size_t b, std::size_t from, std::size_t to, std::size_t least) {
    double sum = 0;
    std::size_t filled = 0;
    for (std::size_t s = from; s < to; ++s)
      if (std::isfinite(top[b][s])) sum += top[b][s], ++filled;
    return filled >= least ? sum / static_cast<double>(filled) : nan;
  };
  for (std::size_t b = 0; b < kBins; ++b) {
    p.radius_m.push_back((static_cast<double>(b) + .5) * bin);
    p.height_m.push_back(mean(b, 0, kSectors, b < 2 ? 1 : 6));
    if (b < 6) p.apex_m = std::max(p.apex_m, p.height_m.back());
  }
  std::vector<std::size_t> flank;
  for (std::size_t b = 0; b < kBins; ++b)
    if (p.height_m[b] < 0.80 * p.apex_m && p.height_m[b] > std::max(0.15 * p.apex_m, 1.8 * diameter_m) && p.radius_m[b] > 2 * diameter_m)
      flank.push_back(b);
  const auto angle = [&](std::size_t from, std::size_t to, std::size_t least) {
    std::vector<double> x, y;
    for (const std::size_t b : flank)
      if (const double h = mean(b, from, to, least); std::isfinite(h)) x.push_back(p.radius_m[b]), y.push_back(h);
    return x.size() >= 4 ? std::atan(-slope(x, y)) * 180 / std::numbers::pi : nan;
  };
  p.flank_deg = angle(0, kSectors, 6);
  double sum = 0, sum2 = 0, wedges = 0;
  for (std::size_t q = 0; q < 6; ++q)
    if (const double a = angle(6 * q, 6 * q + 6, 1); std::isfinite(a)) sum += a, sum2 += a * a, wedges += 1;
  p.flank_sd_deg = std::sqrt(std::max(0.0, sum2 / wedges - sum * sum / wedges / wedges));
  return p;
}
}  // namespace venato::dem::peers
