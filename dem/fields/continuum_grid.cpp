#include "dem/fields/continuum_grid.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "dem/fields/cg_kernel.h"

namespace venato::dem {

ContinuumGrid make_continuum_grid(const Box& box, const Vec3& cell_m, double width_m) {
  if (!(width_m > 0) || !std::isfinite(width_m)) throw UsageError("continuum fields: the width " + std::to_string(width_m) + " m is not > 0");
  ContinuumGrid grid;
  grid.width_m = width_m;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const double length = box.high[a] - box.low[a];
    if (!(cell_m[a] > 0) || !(length > 0)) throw UsageError(std::string("continuum fields: the cell or the box has no extent along ") + "xyz"[a]);
    grid.periodic[k] = box.periodic[a];
    grid.n[k] = std::max(1, static_cast<int>(std::lround(length / cell_m[a])));
    grid.cell_m[a] = length / grid.n[k];
    grid.low[a] = box.low[a];
    if (grid.n[k] == 1 || grid.periodic[k]) continue;
    const int margin = static_cast<int>(std::ceil(kKernelReach * width_m / grid.cell_m[a]));
    grid.low[a] -= margin * grid.cell_m[a];
    grid.n[k] += 2 * margin;
  }
  return grid;
}
}  // namespace venato::dem
