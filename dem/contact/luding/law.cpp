#include "dem/contact/luding/law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace venato::dem {

double luding_plastic_limit(const Luding& law, double r_eff_m) {
  if (law.k2max_n_m == law.k1_n_m) return std::numeric_limits<double>::infinity();
  return law.k2max_n_m / (law.k2max_n_m - law.k1_n_m) * law.phi_f * 2 * r_eff_m;
}

double luding_unloading_stiffness(const Luding& law, double r_eff_m, double overlap_max_m) {
  return law.k1_n_m + (law.k2max_n_m - law.k1_n_m) * std::min(overlap_max_m / luding_plastic_limit(law, r_eff_m), 1.0);
}

double luding_force(const Luding& law, double r_eff_m, double overlap, LudingHistory& history) {
  if (!(overlap > 0)) {
    history = {};
    return 0;
  }
  const double limit = luding_plastic_limit(law, r_eff_m);
  history.overlap_max_m = std::max(history.overlap_max_m, std::min(overlap, limit));
  const double k2 = luding_unloading_stiffness(law, r_eff_m, history.overlap_max_m);
  const double elastic = k2 * (overlap - (1 - law.k1_n_m / k2) * history.overlap_max_m);
  if (overlap >= history.overlap_max_m) return overlap > limit ? elastic : law.k1_n_m * overlap;
  if (elastic >= -law.k_c_n_m * overlap) return elastic;
  // d_max for which d is the point where k2 (d - d_0) meets -k_c d: s D^2 - s d D - (k1 + k_c) d = 0 with k2 = k1 + s D.
  const double s = (law.k2max_n_m - law.k1_n_m) / limit;
  history.overlap_max_m = 0.5 * (overlap + std::sqrt(overlap * overlap + 4 * (law.k1_n_m + law.k_c_n_m) / s * overlap));
  return -law.k_c_n_m * overlap;
}

void check_luding(const Luding& law) {
  if (!(law.k1_n_m > 0) || !(law.k2max_n_m >= law.k1_n_m) || !std::isfinite(law.k2max_n_m) || !(law.k_c_n_m >= 0) || !(law.phi_f > 0))
    throw UsageError("Luding contact: needs 0 < k1 <= k2max, k_c >= 0 and phi_f > 0");
}
}  // namespace venato::dem
