#pragma once
#include <string>
#include <vector>
namespace venato::line {

/// Regular grid of the powder bed in the belt frame. The design lies at [trim, trim + width) x [lead, lead + length); the lead-in and lead-out are body
/// powder only, so that delays and blurs have room. x has side walls (mirror), y is one period of the endless strip.
struct BedGrid {
  int nx = 0, ny = 0, nz = 0;  ///< nz mass layers zeta, bottom first, equal mass
  double pitch_m = 0;          ///< x and y
  double lead_m = 0;           ///< length of lead-in (= lead-out)
  std::size_t columns() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  bool operator==(const BedGrid&) const = default;
};

/// Mass of each powder on the belt: mass_kg_m2[powder][layer][y][x] is the areal mass held by that layer. The volume fraction of powder k in a cell
/// is its share of the cell's mass (all powders of a line have the same granule density; the chain refuses others).
struct Bed {
  BedGrid grid;
  std::vector<std::string> powders;
  std::vector<std::vector<double>> mass;  ///< [powder][(layer * ny + y) * nx + x]
  double total_mass_kg() const;
  double powder_mass_kg(std::size_t powder) const;
  std::vector<double> areal_mass() const;  ///< [y][x] sum over layers and powders
};
Bed make_bed(const BedGrid& grid, std::vector<std::string> powders);  ///< all zero
}  // namespace venato::line
