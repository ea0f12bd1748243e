#pragma once
#include "graphics/raster/raster.h"
namespace venato::graphics {
/// L* / 100 of each pixel (1 or 3 channels sRGB).
RasterF lightness(const Raster8& srgb);
/// Local background of a one-channel raster: the `rank` quantile (0 to 1) over a square window, smoothed. A quantile and not a mean, so that
/// the veins themselves, up to 1 - rank of the window's area (rank > 1/2, veins dark), do not pull it.
RasterF local_background(const RasterF& image, double window_m, double rank);
}  // namespace venato::graphics
