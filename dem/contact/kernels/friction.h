#pragma once
/// Tangential spring-dashpot with Coulomb cap, and EPSD rolling: shared by all laws (design.md 7). One capped spring serves both: force and
/// sliding, torque and rolling.
#include "dem/contact/kernels/contact_types.h"

namespace venato::dem {

/// Ratio by which springs shrink when the contact unloads; 1 for a new or loading contact.
VENATO_KERNEL double unload_ratio(double radius_now, double radius_before) { return radius_now < radius_before ? radius_now / radius_before : 1.0; }

/// Incremental spring, rescaled when the contact unloads (so a closed loop never gains energy: verification.md 5.5), turned rigidly with the contact.
/// The spring alone is cut to the cap; spring + damping together are cut again without touching the spring; no damping while it slips (rule REC of
/// verification.md 0: |F| = cap all through gross sliding, 3.7).
/// \param spring  [N] or [N m], in: of the last step; out: of this step
/// \param rate    [m/s] or [rad/s], across the normal
/// \return total on i, |total| <= cap
VENATO_KERNEL Trio capped_spring(Trio& spring, const ContactGeometry& g, double ratio, const Trio& rate, double stiffness, double damping, double cap,
                                 double dt) {
  const Trio turned = across(rotate(spring, g.turn), g.normal);  // projection only removes rounding
  const Trio trial = ratio * turned - (stiffness * dt) * rate;
  const double cap2 = cap * cap;
  const bool slips = dot(trial, trial) > cap2;
  const Trio whole = trial - (slips ? 0.0 : damping) * rate;
  const double size2 = dot(whole, whole);
  const double cut = cap / std::sqrt(size2);  // taken or not: lanes know no branches
  const Trio total = (size2 > cap2 ? cut : 1.0) * whole;
  spring = Trio{slips ? total.x : trial.x, slips ? total.y : trial.y, slips ? total.z : trial.z};
  return total;
}

/// Energy lost by one capped spring in one step: shrinking / stiffening, slip (both in .first), damping (.second). Each is >= 0.
struct SpringLoss {
  double plastic, damping;
};
inline SpringLoss spring_loss(const Trio& before, const Trio& after, const Trio& total, const ContactGeometry& g, double ratio, const Trio& rate,
                              double stiffness_before, double stiffness, double dt) {
  if (!(stiffness > 0)) return {0, -dot(total, rate) * dt};
  const Trio shrunk = ratio * across(rotate(before, g.turn), g.normal);
  const Trio trial = shrunk - (stiffness * dt) * rate;
  const double held = stiffness_before > 0 ? dot(before, before) / (2 * stiffness_before) : 0;
  const double rescaling = held - dot(shrunk, shrunk) / (2 * stiffness);
  // Work of the integrator over the slipped part: mean spring force of the step times the slip, not the difference of squares (which adds k (v dt)^2
  // / 2 per step).
  const double slip = dot(shrunk + after, trial - after) / (2 * stiffness);
  return {rescaling + slip, -dot(total - after, rate) * dt};
}

inline constexpr double kEpsdStiffness = 2.25;  ///< [-] k_r = 2.25 k_n mu_r^2 R*^2 (Ai, Chen, Rotter & Ooi 2011, model C)
}  // namespace venato::dem
