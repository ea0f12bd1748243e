#pragma once
/// Thornton & Ning's elastic-plastic normal contact without adhesion, quasi-static.
///
///   Hertz up to yield:          a_y = pi R* p_y / (2 E*),  d_y = a_y^2 / R*,  P_y = 4/3 E* sqrt(R*) d_y^1.5
///   plastic loading:            P = P_y + pi p_y R* (d - d_y)
///   unloading, reloading from (d_max, P_max): Hertz on the flattened radius R_p = R* P_e(d_max) / P_max, P_e = 4/3 E* sqrt(R*) d_max^1.5,
///                               P = 4/3 E* sqrt(R_p) (d - d_p)^1.5 with d_p from P(d_max) = P_max
/// Validity: small contacts, a << R*. Source: Thornton & Ning 1998 as given in multiscale.md 3.1.
#include <string_view>

namespace venato::dem {

struct ThorntonNing {
  static constexpr std::string_view name = "thornton_ning";
  double e_eff_pa = 0;           ///< E*
  double yield_pressure_pa = 0;  ///< p_y; infinite = Hertz
};
struct ThorntonNingHistory {
  double overlap_max_m = 0;  ///< starts at 0, is reset when the contact opens
};
/// The unloading branch that belongs to a largest overlap.
struct ThorntonNingUnloading {
  double force_max_n, r_p_m, overlap_p_m;  ///< P_max, R_p (R* before yield), d_p (0 before yield)
};

double thornton_ning_yield_overlap(const ThorntonNing& law, double r_eff_m);  ///< d_y [m]
ThorntonNingUnloading thornton_ning_unloading(const ThorntonNing& law, double r_eff_m, double overlap_max_m);
/// Force [N] >= 0. \param overlap_m [m]; <= 0: contact open, force 0, history reset. Updates the history.
double thornton_ning_force(const ThorntonNing& law, double r_eff_m, double overlap_m, ThorntonNingHistory& history);
/// Impact speed at which yielding begins [m/s]: 1/2 m* V_y^2 = 8/15 E* sqrt(R*) d_y^2.5 (3.194 (p_y^5 R*^3 / (E*^4 m*))^(1/2) in the source).
double thornton_ning_yield_speed(const ThorntonNing& law, double r_eff_m, double m_eff_kg);
/// Closed form of the coefficient of restitution at V >= 0; 1 up to V_y.
double thornton_ning_restitution(double speed_m_s, double yield_speed_m_s);
/// \throws UsageError for E* <= 0 or p_y <= 0 or NaN.
void check_thornton_ning(const ThorntonNing& law);
}  // namespace venato::dem
