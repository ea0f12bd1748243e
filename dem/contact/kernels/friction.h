#pragma once
/// Tangential spring-dashpot with Coulomb cap, and EPSD rolling: shared by all laws (design.md 7). One capped spring serves both: force and
/// sliding, torque and rolling.
#include "dem/contact/kernels/contact_types.h"

namespace venato::dem {

/// Ratio by which springs shrink when the contact unloads, from the measure that the stiffness goes with; 1 for a new or loading contact.
VENATO_KERNEL double unload_ratio(double now, double before) { return now < before ? now / before : 1.0; }

/// What one capped spring of a contact starts from.
struct SpringInput {
  Trio rate;  ///< [m/s] or [rad/s], across the normal
  double stiffness, damping, cap;
};

/// Incremental spring, rescaled when the contact unloads (so a closed loop never gains energy: verification.md 5.5), turned rigidly with the contact.
/// The spring alone is cut to the cap; spring + damping together are cut again without touching the spring; no damping while it slips (rule REC of
/// verification.md 0: |F| = cap all through gross sliding, 3.7).
/// Sliding and rolling are done together, so that they share a division: lanes know no branches, both cuts are computed whether needed or not.
/// \param spring  [N] or [N m], in: of the last step; out: of this step
/// \param total   out: on i, |total| <= cap
VENATO_KERNEL void capped_springs(Trio& slide_spring, Trio& roll_spring, const ContactGeometry& g, double ratio, const SpringInput& slide,
                                  const SpringInput& roll, double dt, Trio& slide_total, Trio& roll_total) {
  constexpr double kTiny = 1e-300;  // keeps 0 / 0 out of cuts that are not taken
  const Trio slide_trial = fused::add(-(slide.stiffness * dt), slide.rate, turned(slide_spring, g.turn, g.normal, ratio));
  const Trio roll_trial = fused::add(-(roll.stiffness * dt), roll.rate, turned(roll_spring, g.turn, g.normal, ratio));
  const double slide_cap2 = slide.cap * slide.cap, roll_cap2 = roll.cap * roll.cap;
  const bool slips = fused::dot(slide_trial, slide_trial) > slide_cap2, rolls_through = fused::dot(roll_trial, roll_trial) > roll_cap2;
  const Trio slide_whole = fused::add(slips ? 0.0 : -slide.damping, slide.rate, slide_trial);
  const Trio roll_whole = fused::add(rolls_through ? 0.0 : -roll.damping, roll.rate, roll_trial);
  const double slide_size2 = fused::dot(slide_whole, slide_whole), roll_size2 = fused::dot(roll_whole, roll_whole);
  const double slide_size = std::sqrt(slide_size2 > kTiny ? slide_size2 : kTiny), roll_size = std::sqrt(roll_size2 > kTiny ? roll_size2 : kTiny);
  const double q = 1 / (slide_size * roll_size), slide_cut = slide.cap * (q * roll_size), roll_cut = roll.cap * (q * slide_size);
  slide_total = (slide_size2 > slide_cap2 ? slide_cut : 1.0) * slide_whole;
  roll_total = (roll_size2 > roll_cap2 ? roll_cut : 1.0) * roll_whole;
  slide_spring = Trio{slips ? slide_total.x : slide_trial.x, slips ? slide_total.y : slide_trial.y, slips ? slide_total.z : slide_trial.z};
  roll_spring = Trio{rolls_through ? roll_total.x : roll_trial.x, rolls_through ? roll_total.y : roll_trial.y, rolls_through ? roll_total.z : roll_trial.z};
}

/// Energy lost by one capped spring in one step: shrinking / stiffening, slip (both in .first), damping (.second). Each is >= 0.
struct SpringLoss {
  double plastic, damping;
};
inline SpringLoss spring_loss(const Trio& before, const Trio& after, const Trio& total, const ContactGeometry& g, double ratio, const Trio& rate,
                              double stiffness_before, double stiffness, double dt) {
  if (!(stiffness > 0)) return {0, -dot(total, rate) * dt};
  const Trio shrunk = turned(before, g.turn, g.normal, ratio);
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
