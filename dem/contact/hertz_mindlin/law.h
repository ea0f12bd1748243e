#pragma once
/// Hertz-Mindlin contact with clamped damping, incremental rescaled tangential spring and EPSD rolling friction (design.md 7).
///
///   F_n = max(0, 4/3 Y* a d + gamma_n d')           a = sqrt(R* d) contact radius, d overlap, d' its rate
///   k_t = 8 G* a,  gamma_t = 2 sqrt(5/6) beta sqrt(k_t m*),  |F_t| <= mu F_n
///   k_r = 2.25 k_n mu_r^2 R*^2,  C_r = 2 eta_r sqrt(I_r k_r),  |M| <= mu_r R* F_n,  torsion off
/// beta is solved so that the measured restitution is the input (dem/contact/kernels/restitution.h); the tangential damper uses the same beta.
/// Validity: a / R* < 0.3; independent of coarse graining (verification.md 7.1).
/// Source: verification.md 1.1, 4.1.
#include <cmath>

#include "dem/contact/kernels/friction.h"
#include "dem/material.h"

namespace venato::dem {

struct HertzMindlin {
  static constexpr std::string_view name = "hertz_mindlin_epsd";
  static constexpr int parameter_count = 9, history_count = 6;
  double young_eff, shear_eff;               ///< [Pa] [Pa]
  double beta;                               ///< [-] damping factor, 0 = elastic
  double friction;                           ///< [-]
  double rolling_friction, rolling_damping;  ///< [-] mu_r, eta_r
  /// Damping coefficients with the contact's own sizes taken out: gamma_n = normal_damper sqrt(a m*), gamma_t = tangential_damper sqrt(a m*),
  /// C_r = rolling_damper R* sqrt(a I_r). Square roots of material numbers stay out of the contact loop. Set by hertz_mindlin().
  double normal_damper, tangential_damper, rolling_damper;  ///< [sqrt(Pa)]

  struct Stiffness {
    double radius, normal, tangential, rolling;
  };
  VENATO_KERNEL Stiffness stiffness(const ContactGeometry& g, double radius) const {
    const double k_n = 4.0 / 3.0 * young_eff * radius;
    const double arm = rolling_friction * g.r_eff;
    return {radius, k_n, 8 * shear_eff * radius, kEpsdStiffness * k_n * arm * arm};
  }
  VENATO_KERNEL Stiffness stiffness(const ContactGeometry& g) const { return stiffness(g, std::sqrt(g.r_eff * g.overlap)); }

  VENATO_KERNEL ContactForce force(const ContactGeometry& g, ContactHistory& h, double dt) const {
    const Stiffness k = stiffness(g);
    const double root_am = std::sqrt(k.radius * g.m_eff);
    const double push = fused::add(k.normal, g.overlap, (normal_damper * root_am) * g.approach);
    const double f_n = push > 0 ? push : 0.0;
    const double ratio = g.overlap < g.overlap_before ? std::sqrt(g.overlap / g.overlap_before) : 1.0;
    const double c_roll = rolling_damper * g.r_eff * std::sqrt(k.radius * g.i_roll);
    ContactForce f;
    f.normal = f_n;
    capped_springs(h.spring, h.rolling, g, ratio, {g.slide, k.tangential, tangential_damper * root_am, friction * f_n},
                   {g.roll, k.rolling, c_roll, rolling_friction * g.r_eff * f_n}, dt, f.tangential, f.rolling);
    return f;
  }

  ContactEnergy energy(const ContactGeometry& g, const ContactHistory& h) const {
    const Stiffness k = stiffness(g);
    return {0.4 * k.normal * g.overlap * g.overlap, k.tangential > 0 ? dot(h.spring, h.spring) / (2 * k.tangential) : 0,
            k.rolling > 0 ? dot(h.rolling, h.rolling) / (2 * k.rolling) : 0};
  }

  ContactLoss loss(const ContactGeometry& g, const ContactHistory& before, const ContactHistory& after, const ContactForce& f, double dt) const {
    const Stiffness k = stiffness(g), old = stiffness(g, std::sqrt(g.r_eff * g.overlap_before));
    const double ratio = unload_ratio(k.radius, old.radius);
    const SpringLoss t = spring_loss(before.spring, after.spring, f.tangential, g, ratio, g.slide, old.tangential, k.tangential, dt);
    const SpringLoss r = spring_loss(before.rolling, after.rolling, f.rolling, g, ratio, g.roll, old.rolling, k.rolling, dt);
    return {(f.normal - k.normal * g.overlap) * g.approach * dt, t.damping, t.plastic, r.plastic + r.damping};
  }

  static constexpr double kDamping = 1.8257418583505538;  ///< 2 sqrt(5/6)
};
static_assert(ContactLaw<HertzMindlin>);

/// The law from its six physical numbers.
HertzMindlin hertz_mindlin(double young_eff, double shear_eff, double beta, double friction, double rolling_friction, double rolling_damping);

/// Law of a material pair; solves the damping factor once. \pre the table has passed check_materials()
HertzMindlin make_hertz_mindlin(const MaterialTable& table, int material_a, int material_b);
}  // namespace venato::dem
