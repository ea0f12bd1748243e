#pragma once
/// How far each grain may go before the neighbour list must be made anew, adapted to the flow.
///
/// Every grain gets a drift velocity U (of its surroundings; its own where it flies much faster than they do) and an allowance s. The list stays
/// good while every grain is within s of the path x0 + U t, for at most `life_s`. So the pairs that have to be listed are those whose drifting
/// spheres of radius r + s meet within the life: a bed that moves or shears as a whole needs no thick skin, and one fast grain does not thicken
/// everybody's. With `fixed_skin_m` it is the classical Verlet list: U = 0, s = skin / 2.
/// The plan never changes results, only how often lists are built and how long they are.
#include <span>
#include <vector>

#include "dem/contact/kernels/trio.h"
#include "dem/neighbours/cell_grid.h"

namespace venato::dem {

/// Start of a grain's path and what it may stray from it. Single precision where the numbers are choices, not measurements.
struct Anchor {
  double x, y, z;                              ///< [m] when the list was built
  float allowance, drift_x, drift_y, drift_z;  ///< [m] [m/s]
  /// Square of the distance from the path at `seconds` after the build [m2].
  double strayed2(double now_x, double now_y, double now_z, double seconds) const {
    const double a = now_x - x - seconds * static_cast<double>(drift_x), b = now_y - y - seconds * static_cast<double>(drift_y),
                 c = now_z - z - seconds * static_cast<double>(drift_z);
    return a * a + b * b + c * c;
  }
};

/// What experience with the last lists says; steers the next.
struct ReachExperience {
  double spread = 4;  ///< allowance in rms fluctuation velocities times life
  double eager = 1;   ///< life in units of the one planned from the fluctuations
  void list_ended(bool strayed_early);
};

struct ReachInput {
  std::span<const Sphere> spheres;  ///< wrapped into the box
  std::span<const Trio> velocity;   ///< [m/s]
  PeriodicBox box;
  double gravity_m_s2 = 0, time_step_s = 0;
  double fixed_skin_m = 0;  ///< > 0: classical list
  ReachExperience experience;
  int threads = 1;
};

struct ReachPlan {
  std::vector<Anchor> anchor;  ///< [grain]
  std::vector<double> reach;   ///< [grain] [m]: pairs farther apart than the sum of their reaches cannot meet within the life
  double life_s = 0;           ///< infinite for a classical list
  double farthest_m = 0;       ///< no grain is farther from its place at the build than this while the list is good
};

/// \throws UsageError when a periodic length is below 2.1 diameters of the largest grain.
ReachPlan plan_reach(const ReachInput& in);

/// Drifting spheres i and j (radius + allowance, relative place d0 [m], relative drift u [m/s]) meet within the life.
inline bool meet_within(double dx, double dy, double dz, double ux, double uy, double uz, double reach, double life_s) {
  const double reach2 = reach * reach, d2 = dx * dx + dy * dy + dz * dz;
  if (d2 < reach2) return true;
  const double du = dx * ux + dy * uy + dz * uz;
  if (!(du < 0)) return !(d2 >= reach2);  // part (or NaN: listed, so that it is looked at)
  const double u2 = ux * ux + uy * uy + uz * uz, t = u2 * life_s > -du ? -du / u2 : life_s;
  return d2 + t * (2 * du + t * u2) < reach2;
}
}  // namespace venato::dem
