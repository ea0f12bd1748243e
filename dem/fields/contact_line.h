#pragma once
#include "dem/simulation/simulation.h"
namespace venato::dem {

/// The line that a contact's stress is spread over: from the centre of a grain that moves to the centre of the other one, or to the contact point on
/// a wall or a frozen grain (Weinhart et al. 2012).
struct ContactLine {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  Vec3 force_n = Vec3::Zero();  ///< on the grain at `from`
  bool wall = false;            ///< `to` is a contact point: -force acts on the boundary there
  bool none = false;            ///< nothing that moves takes part
};
/// \param j the other grain, null for a wall.
ContactLine contact_line(const ContactState& contact, const GrainState& i, const GrainState* j);
}  // namespace venato::dem
