#pragma once
/// Luding's adhesive elasto-plastic normal contact (piecewise linear, stiffness grows with the largest overlap), quasi-static: damping is the
/// caller's.
///
///   d_lim = k2max / (k2max - k1) phi_f 2 R_eff         overlap from which the contact is elastic with k2max
///   k2    = k1 + (k2max - k1) min(d_max / d_lim, 1),   d_0 = (1 - k1/k2) d_max
///   f     = k1 d                 on virgin loading,     k2 (d - d_0) in between,     -k_c d on the adhesive limit
/// On the adhesive limit d_max falls. Deviation: the source sets d_max = (k2 + k_c)/(k2 - k1) d with the old k2; here d_max is solved for so that
/// -k_c d is the limit of the *new* k2 too (a quadratic), otherwise the force jumps back and forth by O(step) while the contact is pulled.
/// Validity: R_eff = R1 R2 / (R1 + R2), a wall has R_eff = R; phi_f is the plastic depth in diameters of R_eff.
/// Source: Luding 2008 as given in multiscale.md 3.1 (same in MercuryDPM and LIGGGHTS).
#include <string_view>

namespace venato::dem {

struct Luding {
  static constexpr std::string_view name = "luding";
  double k1_n_m = 0;     ///< > 0 virgin loading
  double k2max_n_m = 0;  ///< >= k1 unloading of a fully compressed contact
  double k_c_n_m = 0;    ///< >= 0 adhesion
  double phi_f = 0;      ///< > 0 dimensionless plasticity depth
};
struct LudingHistory {
  double overlap_max_m = 0;  ///< in [0, d_lim]; starts at 0, is reset when the contact opens
};

/// d_lim [m]; infinite when k2max = k1 (the law is then Hooke's).
double luding_plastic_limit(const Luding& law, double r_eff_m);
/// k2 [N/m] at that history.
double luding_unloading_stiffness(const Luding& law, double r_eff_m, double overlap_max_m);
/// Force [N], > 0 repels. \param overlap_m [m]; <= 0: contact open, force 0, history reset. Updates the history.
double luding_force(const Luding& law, double r_eff_m, double overlap_m, LudingHistory& history);
/// \throws UsageError for k1 <= 0, k2max < k1, k_c < 0, phi_f <= 0 or NaN.
void check_luding(const Luding& law);
}  // namespace venato::dem
