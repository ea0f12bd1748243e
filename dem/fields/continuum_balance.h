#pragma once
#include <span>
#include <vector>

#include "dem/fields/continuum_grid.h"
#include "dem/simulation/simulation.h"
namespace venato::dem {

/// Force balance of one instant in every cell [N per m3]:  sum_i F_i phi(r - r_i)  =  div sigma_c + rho g + t,  where F_i is the total force on grain
/// i. The left side comes from the grains, the divergence from the contact stress on the faces of the cells (its own line integrals): what the two
/// sides differ by is the error of the fields. With inertia, d(j)/dt + div(sum m v v phi) is the same left side.
struct MomentumBalance {
  std::vector<Vec3> grain_force, divergence, weight, wall;  ///< F phi, div sigma_c, rho g, t
  double largest_residual = 0;                              ///< max |left - right|
  double largest_term = 0;                                  ///< max of the norms of the four terms
};
/// \pre grains and contacts of the same step, with valid forces. Frozen grains belong to the boundary.
MomentumBalance momentum_balance(const ContinuumGrid& grid, std::span<const GrainState> grains, std::span<const ContactState> contacts,
                                 const Vec3& gravity_m_s2);
}  // namespace venato::dem
