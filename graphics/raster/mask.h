#pragma once
/// Binary masks: one channel, 0 = out, anything else = in.
#include "graphics/raster/raster.h"
namespace venato::graphics {

/// Euclidean distance [px] from each pixel centre to the nearest centre inside the mask; 0 inside; 1e6 everywhere for an empty mask.
RasterF distance_to(const Raster8& mask);
/// Signed distance [px] to the outline that runs half way between in and out: positive inside.
RasterF signed_distance(const Raster8& mask);
/// Parts (8-connected) smaller than min_pixels removed.
Raster8 without_small_parts(const Raster8& mask, double min_pixels);
/// Holes (4-connected, not touching the border) smaller than min_pixels filled.
Raster8 without_small_holes(const Raster8& mask, double min_pixels);
/// Centre lines, one pixel wide, same topology. Source: Zhang, Suen, Comm. ACM 27 (1984) 236,
/// with each removal checked again so that no part or hole is lost.
Raster8 thin(const Raster8& mask);
/// Pixels outside the mask take the value of the nearest one inside; unchanged for an empty mask. Same size, any channels.
Raster8 continued_outside(const Raster8& image, const Raster8& mask);
RasterF gaussian(const RasterF& image, double sigma_px);  ///< reflected border; sigma <= 0: unchanged
}  // namespace venato::graphics
