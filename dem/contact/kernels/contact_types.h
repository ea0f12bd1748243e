#pragma once
/// What a contact law sees and returns. The same types serve grain-grain and grain-wall contacts ("i" is the grain, "j" the other side).
#include <concepts>
#include <string_view>
#include "dem/contact/kernels/trio.h"

namespace venato::dem {

struct ContactGeometry {
  double overlap;   ///< [m] > 0
  double overlap_before;  ///< [m] of the last step, 0 if there was none: springs shrink with it
  double approach;  ///< [m/s] d(overlap)/dt, half-step velocities, full-step normal
  Trio slide;       ///< [m/s] surface velocity of i relative to j, across the normal; taken with the half-step normal (verification.md 5.8)
  Trio roll;        ///< [rad/s] spin of i minus spin of j, across the normal
  Trio normal;      ///< unit, from i to j
  FrameTurn turn;   ///< rotation of the frame since the last step
  double r_eff;     ///< [m]  1/R* = 1/Ri + 1/Rj; wall: R
  double m_eff;     ///< [kg] likewise; wall: m
  double i_roll;    ///< [kg m2] 1/Ir = sum 1/(I + m R^2); wall: 1.4 m R^2
};

/// Everything a contact remembers between steps. All zero = new contact.
struct ContactHistory {
  Trio spring;         ///< [N] tangential spring force on i
  Trio rolling;        ///< [N m] rolling spring torque on i
  double plastic = 0;  ///< EEPA: (plastic overlap)^n [m^n]; else unused
};

struct ContactForce {
  double normal;    ///< [N] > 0 pushes apart
  Trio tangential;  ///< [N] on i
  Trio rolling;     ///< [N m] on i
};

/// Elastic energy held by the contact and the energy that the last step dissipated, by channel [J].
struct ContactEnergy {
  double elastic_normal = 0, elastic_tangential = 0, elastic_rolling = 0;
};
struct ContactLoss {
  double normal = 0, tangential_damping = 0, sliding = 0, rolling = 0;
};

template <class L>
concept ContactLaw = requires(const L law, const ContactGeometry& g, ContactHistory& h, const ContactHistory& old, const ContactForce& f, double dt) {
  { L::name } -> std::convertible_to<std::string_view>;
  { L::parameter_count } -> std::convertible_to<int>;  ///< the law is that many doubles and nothing else
  { L::history_count } -> std::convertible_to<int>;    ///< numbers of ContactHistory, from the first, that it uses
  { law.force(g, h, dt) } -> std::same_as<ContactForce>;
  { law.energy(g, old) } -> std::same_as<ContactEnergy>;
  { law.loss(g, old, old, f, dt) } -> std::same_as<ContactLoss>;  ///< (geometry, history before, history after, force, dt)
};
}  // namespace venato::dem
