#pragma once
#include "graphics/raster/raster.h"
namespace venato::sync {

/// Exact Euclidean distance [px] of every pixel centre to the nearest set (nonzero) pixel centre; infinity everywhere if none is set.
/// Source: Felzenszwalb & Huttenlocher, Theory of Computing 8 (2012) 415. Own instead of cv::distanceTransform: exact in double and free of its size
/// limits.
graphics::RasterF distance_to(const graphics::Raster8& set);
/// Mask minus its erosion by the 4-neighbourhood; pixels beyond the image border count as inside (they do not make a boundary).
graphics::Raster8 boundary(const graphics::Raster8& mask);
/// Plain Zhang-Suen thinning, staircases kept: what clDice is defined on.
graphics::Raster8 zhang_suen(const graphics::Raster8& mask);
}  // namespace venato::sync
