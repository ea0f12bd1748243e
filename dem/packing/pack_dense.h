#pragma once
/// Dense random packing of spheres, ready for the engine: no force, no friction, made at once instead of poured.
///
/// What:     spheres at random places of a box (one per cell of a grid), then overlaps removed by energy minimisation of soft frictionless spheres.
/// Input:    radii [m], any mix; a box whose periodic directions wrap and whose other faces are hard and flat (z not periodic: floor and lid).
/// Output:   positions [m] in the order of the radii; what was reached.
/// Validity: solid fractions up to about 0.63 for equal spheres in a periodic box (random jamming at 0.64), more for wide size mixes, less between
/// close
///           faces. The bits depend on seed and input only, not on the number of threads.
/// Errors:   UsageError for input that makes no sense, and for fractions that the relaxation cannot reach.
/// Source:   jamming of frictionless spheres: O'Hern, Silbert, Liu, Nagel, Phys. Rev. E 68, 011306 (2003).
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/case.h"

namespace venato::dem {

struct PackingOptions {
  double max_overlap = 1e-3;  ///< of the smaller radius of a pair (of the radius, at a face); in (0, 0.2]
  std::uint64_t seed = 0, stream = 0;
  int threads = 1;
};
struct Packing {
  std::vector<Vec3> position_m;  ///< inside the box, [sphere]
  double solid_fraction = 0;     ///< sphere volume / box volume
  double max_overlap = 0;        ///< reached, of the smaller radius
  /// Mean number of neighbours closer than 1 % of the smaller radius: all spheres, and without those that fewer than four neighbours hold (rattlers,
  /// taken away until none is left). 6 at jamming.
  double coordination = 0, backbone_coordination = 0;
  double rattlers = 0;  ///< their share
  std::int64_t iterations = 0;
};

/// \param radii_m [m] > 0. The solid fraction is theirs: sum of volumes / box volume.
/// \throws UsageError bad radii, a box without volume or too small for its largest sphere (periodic: 2.1 diameters as in the engine; else 1), bad
/// options;
///         a fraction that no packing has (>= 0.74 for equal spheres) or that the relaxation does not reach.
Packing pack_dense(const Box& box, std::span<const double> radii_m, const PackingOptions& options);

/// Contact numbers of any set of pairs: mean over all n spheres, and without rattlers.
struct Coordination {
  double all = 0, backbone = 0, rattlers = 0;
};
Coordination coordination_of(std::size_t n, std::span<const std::array<std::int32_t, 2>> pairs);
}  // namespace venato::dem
