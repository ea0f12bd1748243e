#pragma once
#include "graphics/raster/raster.h"
namespace venato::line {
/// Separable Gaussian over all channels, mirrored at the borders (each pixel's channel sum is kept), cut at 4 sigma. Below a twentieth of a pixel:
/// nothing.
void blur_gaussian(graphics::RasterF& raster, double sigma_m, int threads);
}  // namespace venato::line
