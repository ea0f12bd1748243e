#pragma once
#include <array>
#include <cstddef>

#include "dem/case.h"
namespace venato::dem {

/// Box-shaped cells of the continuum fields. A direction with one cell is averaged over: the fields are means over the whole length of the box
/// along it. In resolved directions that are not periodic the grid reaches one kernel beyond the box, so that no mass falls off it.
struct ContinuumGrid {
  Vec3 low = Vec3::Zero(), cell_m = Vec3::Zero();  ///< corner of cell (0, 0, 0); size of a cell
  std::array<int, 3> n{1, 1, 1};
  std::array<bool, 3> periodic{};
  double width_m = 0;  ///< w of the kernel

  std::size_t size() const { return static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]); }
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(n[1]) + static_cast<std::size_t>(j)) * static_cast<std::size_t>(n[0]) +
           static_cast<std::size_t>(i);
  }
  double cell_volume_m3() const { return cell_m.prod(); }
  bool resolved(int axis) const { return n[static_cast<std::size_t>(axis)] > 1; }
  double centre_m(int axis, int k) const { return low[axis] + (k + 0.5) * cell_m[axis]; }
};

/// \param cell_m wanted size of the cells [m]: fitted to the box (a whole number of cells along each direction); at least the length of the box =
/// one cell, averaged over.  \param width_m w of the kernel, > 0.
/// \throws UsageError for sizes that are not > 0.
ContinuumGrid make_continuum_grid(const Box& box, const Vec3& cell_m, double width_m);
}  // namespace venato::dem
