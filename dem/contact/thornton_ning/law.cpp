#include "dem/contact/thornton_ning/law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace venato::dem {
namespace {
double hertz(double e_eff, double radius, double overlap) { return 4.0 / 3 * e_eff * std::sqrt(radius) * overlap * std::sqrt(overlap); }
}  // namespace

double thornton_ning_yield_overlap(const ThorntonNing& law, double r_eff_m) {
  const double a_y = std::numbers::pi * r_eff_m * law.yield_pressure_pa / (2 * law.e_eff_pa);
  return a_y * a_y / r_eff_m;
}

ThorntonNingUnloading thornton_ning_unloading(const ThorntonNing& law, double r_eff, double overlap_max) {
  const double d_y = thornton_ning_yield_overlap(law, r_eff), elastic = hertz(law.e_eff_pa, r_eff, overlap_max);
  if (overlap_max <= d_y) return {elastic, r_eff, 0};
  const double force = hertz(law.e_eff_pa, r_eff, d_y) + std::numbers::pi * law.yield_pressure_pa * r_eff * (overlap_max - d_y);
  const double r_p = r_eff * elastic / force;
  return {force, r_p, overlap_max - std::pow(3 * force / (4 * law.e_eff_pa * std::sqrt(r_p)), 2.0 / 3)};
}

double thornton_ning_force(const ThorntonNing& law, double r_eff, double overlap, ThorntonNingHistory& history) {
  if (!(overlap > 0)) {
    history = {};
    return 0;
  }
  history.overlap_max_m = std::max(history.overlap_max_m, overlap);
  const ThorntonNingUnloading branch = thornton_ning_unloading(law, r_eff, history.overlap_max_m);
  if (overlap == history.overlap_max_m) return branch.force_max_n;
  return overlap > branch.overlap_p_m ? hertz(law.e_eff_pa, branch.r_p_m, overlap - branch.overlap_p_m) : 0;
}

double thornton_ning_yield_speed(const ThorntonNing& law, double r_eff_m, double m_eff_kg) {
  const double d_y = thornton_ning_yield_overlap(law, r_eff_m);
  return std::sqrt(16.0 / 15 * law.e_eff_pa * std::sqrt(r_eff_m) * d_y * d_y * std::sqrt(d_y) / m_eff_kg);
}

double thornton_ning_restitution(double speed_m_s, double yield_speed_m_s) {
  if (!(speed_m_s > yield_speed_m_s)) return 1;
  const double r = yield_speed_m_s / speed_m_s;
  return std::sqrt(6 * std::sqrt(3.0) / 5) * std::sqrt(1 - r * r / 6) * std::pow(r / (r + 2 * std::sqrt(1.2 - 0.2 * r * r)), 0.25);
}

void check_thornton_ning(const ThorntonNing& law) {
  if (!(law.e_eff_pa > 0) || !(law.yield_pressure_pa > 0)) throw UsageError("Thornton-Ning contact: needs E* > 0 and a yield pressure > 0");
}
}  // namespace venato::dem
