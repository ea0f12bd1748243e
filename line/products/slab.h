#pragma once
#include <vector>
#include "graphics/raster/raster.h"
#include "line/products/bed.h"
namespace venato::line {

/// The pressed slab, cut to size, green frame (origin at the cut slab's first corner).
struct Slab {
  Bed bed;  ///< composition over the whole strip period, mass coordinate zeta unchanged by pressing; still on belt coordinates
  graphics::RasterF thickness_m, density_kg_m3, pressure_pa;  ///< green frame, one channel
  /// Where on the belt the powder of each green pixel centre lay.
  graphics::RasterF belt_from_green_m;  ///< 2 channels: belt x, belt y [m]
  double in_plane_scale = 1;            ///< 1 + springback
  double sigma_nonaffine_m = 0;         ///< press blur measured by the DEM slice (coarse-graining corrected)
};
}  // namespace venato::line
