#pragma once
#include <string>
#include <vector>
namespace venato::dem {

/// Bulk properties of a grain or wall material.
struct Material {
  std::string name;
  double density_kg_m3 = 0;       ///< of the grain (apparent), not of the bed; walls: unused
  double young_modulus_pa = 0;    ///< softened for the time step, as in the seed paper
  double poisson_ratio = 0;
};

/// Properties of a pair of materials (grain-grain or grain-wall), symmetric.
struct PairProperties {
  double restitution = 0;               ///< measured value: the damping coefficient is solved for it (design.md 7)
  double sliding_friction = 0;
  double rolling_friction = 0;          ///< mu_r of EPSD, dimensionless
  double rolling_damping_ratio = 0;     ///< eta_r of EPSD
};

/// Materials and the properties of every pair of them. Index = material id used by grains and walls.
struct MaterialTable {
  std::vector<Material> materials;
  std::vector<PairProperties> pairs;    ///< row-major n x n, symmetric
  const PairProperties& pair(int a, int b) const { return pairs[static_cast<std::size_t>(a) * materials.size() + static_cast<std::size_t>(b)]; }
};
}  // namespace venato::dem
