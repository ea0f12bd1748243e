#pragma once
/// Overlap removal by energy minimisation: FIRE (Bitzek, Koskinen, Gaehler, Moseler, Gumbsch, Phys. Rev. Lett. 97, 170201, 2006).
#include <cstdint>

#include "dem/packing/soft_spheres.h"

namespace venato::dem {

struct RelaxLimits {
  double max_overlap = 1e-3;  ///< of the smaller hard radius; reached = done
  /// Every 400 iterations it is asked how many more the overlaps would need at the pace of the last 400; more than these, and the search is given up.
  /// The pace only ever falls, so what is given up would have taken longer still: jammed, or as good as.
  std::int64_t most_iterations = 8'000;
  double balance = 0;  ///< > 0: done also when sum of force^2 <= balance * sum of overlap^2, i.e. when jammed spheres hold each other
};
struct RelaxReport {
  bool reached = false, balanced = false;  ///< neither: given up
  std::int64_t iterations = 0;
  double max_overlap = 0;  ///< of the smaller hard radius
  double energy = 0;       ///< [m2] sum of 1/2 overlap^2 of the swollen spheres
};
/// Moves the spheres until the largest hard overlap is within the limit.
RelaxReport relax(SoftSpheres& spheres, const RelaxLimits& limits);
}  // namespace venato::dem
