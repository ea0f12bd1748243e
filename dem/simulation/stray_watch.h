#pragma once
/// Whether a grain of a block has left its path in the neighbour list by more than its allowance. The paths are looked at only when it might have
/// happened: between two looks the watch adds up how far the fastest grain of the block can have come from its path at most. Says the same as a look
/// in every step, without reading every grain's path in every step.
#include <cstddef>
#include <span>

#include "dem/neighbours/reach_plan.h"

namespace venato::dem {

struct StrayWatch {
  double centre[4] = {};  ///< mean drift of the block's paths, and 0 [m/s]
  double spread = 0;      ///< largest distance of a drift from the mean [m/s]
  double slack = -1;      ///< what the grain nearest to straying may stray further [m]; a new list starts with a look
  double last_way = 0;    ///< [m] of the last step

  /// One more step. \param fastest largest |velocity - centre| of the block's grains by axes [m/s] \param rounding of a grain's way [m]
  /// \return whether nobody can have strayed
  bool all_within(const double* fastest, double seconds, double rounding);
  /// Likely to need a look in the next step.
  bool near_look() const { return !(slack > 4 * last_way); }
  /// \param sphere, anchor of the block's grains in the list \param seconds since it was made \return whether one has strayed
  bool look(std::span<const Sphere> sphere, std::span<const Anchor> anchor, double seconds);
};
}  // namespace venato::dem
