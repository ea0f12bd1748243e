#pragma once
/// Edinburgh elasto-plastic adhesive contact (EEPA) for pressing.
///
///   f_hys = f0 + k1 d^n                      on virgin loading
///         = f0 + k2 (d^n - dp^n)             on un- and reloading
///         = f0 - k_adh d^n                   on the adhesive limit (then dp^n = (1 + k_adh/k2) d^n)
///   gamma_n = 2 beta sqrt(m* k1 d^(n-1)),  k_t = 2/7 k1 d^(n-1),  gamma_t = 2 beta sqrt(m* k_t),  |F_t| <= mu |f_hys + k_adh d^n - f0|
/// n = 1.5: k1 = 4/3 Y* sqrt(R*). n = 1: k1 = 4/3 Y* sqrt(R* d_ref) with d_ref = R*/100, so that k1 scales with coarse graining by itself.
/// Deviation: the source writes sqrt(m* k1) and 2/7 k1 for n = 1.5 too, which is not a stiffness there; d^(n-1) makes it one (and keeps the law
/// invariant under coarse graining). Rolling: EPSD as in Hertz-Mindlin with k_n = k1 d^(n-1) and the friction cap's normal force.
/// beta is the textbook value: with plastic loading the restitution is set by k2/k1, not by the damper.
/// Source: Thakur et al. 2014 as given in multiscale.md 3.1.
#include <cmath>

#include "dem/case.h"
#include "dem/contact/kernels/friction.h"
#include "dem/material.h"

namespace venato::dem {

struct Eepa {
  static constexpr std::string_view name = "eepa";
  static constexpr int parameter_count = 9, history_count = 7;
  double young_eff;                                          ///< [Pa]
  double k2_ratio, k_adh_ratio;                              ///< [-] k2/k1 >= 1, k_adh/k1 >= 0
  double linear;                                             ///< 1: n = 1; 0: n = 1.5
  double constant_force;                                     ///< [N] f0, < 0 pulls
  double beta, friction, rolling_friction, rolling_damping;  ///< [-]

  static constexpr double kReferenceStrain = 0.01;  ///< d_ref / R* of the linear variant

  /// k1 in N/m^n.
  VENATO_KERNEL double loading_stiffness(double r_eff) const {
    const double hertz = 4.0 / 3.0 * young_eff * std::sqrt(r_eff);
    return linear > 0 ? hertz * std::sqrt(kReferenceStrain * r_eff) : hertz;
  }
  VENATO_KERNEL double overlap_power(double overlap) const { return linear > 0 ? overlap : overlap * std::sqrt(overlap); }

  /// Hysteretic force without f0 [N]; updates dp^n [m^n].
  VENATO_KERNEL static double hysteresis(double k1, double k2, double k_adh, double overlap_n, double& plastic_n) {
    const double load = k1 * overlap_n, elastic = k2 * (overlap_n - plastic_n), pull = -k_adh * overlap_n;
    const bool virgin = elastic >= load, adhesive = elastic <= pull;
    const double f = virgin ? load : (adhesive ? pull : elastic);
    plastic_n = virgin ? (1 - k1 / k2) * overlap_n : (adhesive ? (1 + k_adh / k2) * overlap_n : plastic_n);
    return f;
  }

  struct Stiffness {
    double k1, radius, normal, tangential, rolling;
  };
  VENATO_KERNEL Stiffness stiffness(const ContactGeometry& g, double radius) const {
    const double k1 = loading_stiffness(g.r_eff), k_n = k1 * radius, arm = rolling_friction * g.r_eff;
    return {k1, radius, k_n, 2.0 / 7.0 * k_n, kEpsdStiffness * k_n * arm * arm};
  }
  /// d^(n-1): plays the part that the contact radius has in Hertz-Mindlin.
  VENATO_KERNEL double measure(double overlap) const { return linear > 0 ? 1.0 : std::sqrt(overlap); }
  VENATO_KERNEL Stiffness stiffness(const ContactGeometry& g) const { return stiffness(g, measure(g.overlap)); }

  VENATO_KERNEL ContactForce force(const ContactGeometry& g, ContactHistory& h, double dt) const {
    const Stiffness k = stiffness(g);
    const double power = overlap_power(g.overlap);
    const double f_hys = hysteresis(k.k1, k2_ratio * k.k1, k_adh_ratio * k.k1, power, h.plastic);
    const double carried = std::abs(f_hys + k_adh_ratio * k.k1 * power);
    const double ratio = unload_ratio(k.radius, measure(g.overlap_before));
    ContactForce f;
    f.normal = constant_force + f_hys + 2 * beta * std::sqrt(g.m_eff * k.normal) * g.approach;
    const double gamma_t = 2 * beta * std::sqrt(g.m_eff * k.tangential), c_roll = 2 * rolling_damping * std::sqrt(g.i_roll * k.rolling);
    capped_springs(h.spring, h.rolling, g, ratio, {g.slide, k.tangential, gamma_t, friction * carried},
                   {g.roll, k.rolling, c_roll, rolling_friction * g.r_eff * carried}, dt, f.tangential, f.rolling);
    return f;
  }

  /// Recoverable part: unloading along k2 to dp.
  VENATO_KERNEL double recoverable(double k2, double overlap, double plastic_n) const {
    const double n = linear > 0 ? 1.0 : 1.5, plastic = linear > 0 ? plastic_n : std::cbrt(plastic_n * plastic_n);
    const double overlap_n = overlap_power(overlap);
    return k2 * ((overlap_n * overlap - plastic_n * plastic) / (n + 1) - plastic_n * (overlap - plastic));
  }
  ContactEnergy energy(const ContactGeometry& g, const ContactHistory& h) const {
    const Stiffness k = stiffness(g);
    return {recoverable(k2_ratio * k.k1, g.overlap, h.plastic), dot(h.spring, h.spring) / (2 * k.tangential),
            k.rolling > 0 ? dot(h.rolling, h.rolling) / (2 * k.rolling) : 0};
  }
  ContactLoss loss(const ContactGeometry& g, const ContactHistory& before, const ContactHistory& after, const ContactForce& f, double dt) const {
    const Stiffness k = stiffness(g), old = stiffness(g, measure(g.overlap_before));
    const double ratio = unload_ratio(k.radius, old.radius), k2 = k2_ratio * k.k1;
    const SpringLoss t = spring_loss(before.spring, after.spring, f.tangential, g, ratio, g.slide, old.tangential, k.tangential, dt);
    const SpringLoss r = spring_loss(before.rolling, after.rolling, f.rolling, g, ratio, g.roll, old.rolling, k.rolling, dt);
    const double step = g.approach * dt, earlier = g.overlap - step > 0 ? g.overlap - step : 0.0;
    // Work of the hysteretic force (trapezoid; f = k2 (d^n - dp^n) holds on every branch once dp is updated) less what stays recoverable, plus
    // damping; f0 counts as work of the contact.
    const double stored = recoverable(k2, g.overlap, after.plastic) - recoverable(k2, earlier, before.plastic);
    const double f_before = k2 * (overlap_power(earlier) - before.plastic), f_after = k2 * (overlap_power(g.overlap) - after.plastic);
    return {0.5 * (f_before + f_after) * step - stored + (f.normal - f_after) * step, t.damping, t.plastic, r.plastic + r.damping};
  }
};
static_assert(ContactLaw<Eepa>);

/// Law of a material pair. \throws UsageError when k2/k1 < 1, k_adh < 0 or the exponent is neither 1 nor 1.5.
Eepa make_eepa(const MaterialTable& table, const EepaParameters& parameters, int material_a, int material_b);
}  // namespace venato::dem
