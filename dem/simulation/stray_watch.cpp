#include "dem/simulation/stray_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace venato::dem {

bool StrayWatch::all_within(const double* fastest, double seconds, double rounding) {
  const double relative = std::sqrt(fastest[0] * fastest[0] + fastest[1] * fastest[1] + fastest[2] * fastest[2]);
  last_way = (1 + 1e-9) * (relative + spread) * seconds + rounding;
  slack -= last_way;
  return slack > 0;  // not for NaN
}

bool StrayWatch::look(std::span<const Sphere> sphere, std::span<const Anchor> anchor, double seconds) {
  bool strayed = false;
  double sum[3] = {};
  slack = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < anchor.size(); ++s) {
    const Anchor& a = anchor[s];
    const double allowance = static_cast<double>(a.allowance), way2 = a.strayed2(sphere[s].x, sphere[s].y, sphere[s].z, seconds);
    strayed |= !(way2 <= allowance * allowance);  // NaN strays
    slack = std::min(slack, allowance - std::sqrt(way2));
    sum[0] += static_cast<double>(a.drift_x), sum[1] += static_cast<double>(a.drift_y), sum[2] += static_cast<double>(a.drift_z);
  }
  if (strayed) slack = -1;
  for (int k = 0; k < 3; ++k) centre[k] = anchor.empty() ? 0.0 : sum[k] / static_cast<double>(anchor.size());
  double spread2 = 0;
  for (const Anchor& a : anchor) {
    const double x = static_cast<double>(a.drift_x) - centre[0], y = static_cast<double>(a.drift_y) - centre[1],
                 z = static_cast<double>(a.drift_z) - centre[2];
    spread2 = std::max(spread2, x * x + y * y + z * z);
  }
  spread = std::sqrt(spread2);
  return strayed;
}
}  // namespace venato::dem
