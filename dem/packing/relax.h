#pragma once
/// Overlap removal by energy minimisation: FIRE (Bitzek, Koskinen, Gaehler, Moseler, Gumbsch, Phys. Rev. Lett. 97, 170201, 2006).
#include <cstdint>

#include "dem/packing/soft_spheres.h"

namespace venato::dem {

struct RelaxLimits {
  double max_overlap = 1e-3;  ///< of the smaller hard radius; reached = done
  std::int64_t most_iterations = 20'000;
  /// Stuck = the energy falls by less than this part in 200 iterations; then the spheres are jammed and hold each other.
  double stuck_fraction = 2e-3;
};
struct RelaxReport {
  bool reached = false;  ///< false: jammed, or most_iterations
  std::int64_t iterations = 0;
  double max_overlap = 0;  ///< of the smaller hard radius
  double energy = 0;       ///< [m2] sum of 1/2 overlap^2 of the swollen spheres
};
/// Moves the spheres until the largest hard overlap is within the limit, or they are jammed.
RelaxReport relax(SoftSpheres& spheres, const RelaxLimits& limits);
}  // namespace venato::dem
