#pragma once
/// COMPARISON ONLY: Hertz with tangential history and EPSD rolling after the formulas of LIGGGHTS-PUBLIC 3.8 ("model hertz tangential history
/// rolling_friction epsd"). It repeats that code's faults on purpose, so that a difference between the two programs can be traced to the law or to
/// the rest. Never use it for predictions: hertz_mindlin_epsd is the product's law.
///
///   F_n = 4/3 Y* a d + gamma_n d'        a = sqrt(R* d); not limited: it pulls at the end of a rebound (real restitution = input)
///   F_t = -k_t xi - gamma_t slide        xi = sum slide dt, projected on the new plane without rescaling; k_t = 8 G* a of now
///   slip where k_t |xi| > mu |F_n|: F_t = mu |F_n| along -xi, xi cut to it, no damping; below, the damping comes on top of the spring uncapped
///   M   = M_k - C_r roll                 dM_k = -k_r roll dt, |M_k| <= mu_r R* |F_n|, damping off while at that limit, else on top uncapped; M_k
///   keeps its
///                                        direction in space when the contact turns
/// k_r = 2.25 k_n mu_r^2 R*^2, C_r = 2 eta_r sqrt(I_r k_r), gamma = 2 sqrt(5/6) beta sqrt(S m*), beta = -ln e / sqrt(ln^2 e + pi^2).
///
/// What the law alone cannot match, because the engine makes the geometry: walls have lever R here and R - d there (spin after sliding about d/R
/// higher here); the sliding velocity is taken with the half-step normal here and the full-step one there (small grains on large ones,
/// verification.md 5.8); one contact per nearest point of a mesh here, one per triangle there.
/// Measured faults (tests/dem/contact/liggghts_hertz_test.cpp): sliding impulse 1.17 mu times the normal one, 4.09e-12 J made in a closed loop.
/// Source: verification.md 1.1, 1.2, 3.7, 4.1, 5.5 (from the source of LIGGGHTS-PUBLIC).
#include <cmath>

#include "dem/contact/kernels/friction.h"
#include "dem/material.h"

namespace venato::dem {

struct LiggghtsHertz {
  static constexpr std::string_view name = "liggghts_hertz";
  static constexpr int parameter_count = 6, history_count = 6;
  double young_eff, shear_eff;               ///< [Pa] [Pa]
  double beta;                               ///< [-] textbook damping factor
  double friction;                           ///< [-]
  double rolling_friction, rolling_damping;  ///< [-] mu_r, eta_r

  static constexpr double kDamping = 1.8257418583505538;  ///< 2 sqrt(5/6)

  struct Stiffness {
    double radius, normal, tangential, rolling;
  };
  VENATO_KERNEL Stiffness stiffness(const ContactGeometry& g, double radius) const {
    const double k_n = 4.0 / 3.0 * young_eff * radius, arm = rolling_friction * g.r_eff;
    return {radius, k_n, 8 * shear_eff * radius, kEpsdStiffness * k_n * arm * arm};
  }
  VENATO_KERNEL Stiffness stiffness(const ContactGeometry& g) const { return stiffness(g, std::sqrt(g.r_eff * g.overlap)); }

  /// A displacement spring kept as a force: F = -k_t xi, so F of the last step times k_t(now) / k_t(then), up and down.
  VENATO_KERNEL static double displacement_ratio(double radius_now, double radius_before) {
    return radius_before > 0 ? radius_now / radius_before : 1.0;
  }

  VENATO_KERNEL ContactForce force(const ContactGeometry& g, ContactHistory& h, double dt) const {
    const Stiffness k = stiffness(g);
    ContactForce f;
    f.normal = k.normal * g.overlap + kDamping * beta * std::sqrt(1.5 * k.normal * g.m_eff) * g.approach;
    const double push = std::abs(f.normal);
    const double gamma_t = kDamping * beta * std::sqrt(k.tangential * g.m_eff);
    const double c_roll = 2 * rolling_damping * std::sqrt(g.i_roll * k.rolling);
    const Trio trial = across(displacement_ratio(k.radius, std::sqrt(g.r_eff * g.overlap_before)) * h.spring - (k.tangential * dt) * g.slide, g.normal);
    f.tangential = limited(h.spring, trial, g.slide, gamma_t, friction * push);
    f.rolling = limited(h.rolling, h.rolling - (k.rolling * dt) * g.roll, g.roll, c_roll, rolling_friction * g.r_eff * push);
    return f;
  }

  ContactEnergy energy(const ContactGeometry& g, const ContactHistory& h) const {
    const Stiffness k = stiffness(g);
    return {0.4 * k.normal * g.overlap * g.overlap, k.tangential > 0 ? dot(h.spring, h.spring) / (2 * k.tangential) : 0,
            k.rolling > 0 ? dot(h.rolling, h.rolling) / (2 * k.rolling) : 0};
  }

  /// `sliding` is negative where the law makes energy (a displacement spring that stiffens under load).
  ContactLoss loss(const ContactGeometry& g, const ContactHistory& before, const ContactHistory& after, const ContactForce& f, double dt) const {
    const Stiffness k = stiffness(g), old = stiffness(g, std::sqrt(g.r_eff * g.overlap_before));
    ContactGeometry still = g;
    still.turn = {};  // springs are projected, not turned
    const double ratio = displacement_ratio(k.radius, old.radius);
    const SpringLoss t = spring_loss(before.spring, after.spring, f.tangential, still, ratio, g.slide, old.tangential, k.tangential, dt);
    const SpringLoss r = spring_loss(before.rolling, after.rolling, f.rolling, still, 1, g.roll, old.rolling, k.rolling, dt);
    return {(f.normal - k.normal * g.overlap) * g.approach * dt, t.damping, t.plastic, r.plastic + r.damping};
  }

 private:
  VENATO_KERNEL static Trio limited(Trio& spring, const Trio& trial, const Trio& rate, double damping, double cap) {
    const double size = length(trial);
    const bool slips = size > cap;
    spring = (slips ? cap / size : 1.0) * trial;
    return spring - (slips ? 0.0 : damping) * rate;
  }
};
static_assert(ContactLaw<LiggghtsHertz>);

/// Law of a material pair. \pre the table has passed check_materials()
LiggghtsHertz make_liggghts_hertz(const MaterialTable& table, int material_a, int material_b);
}  // namespace venato::dem
