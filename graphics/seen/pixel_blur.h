#pragma once
#include "graphics/raster/raster.h"
namespace venato::graphics {

/// A picture of square pixels, each of one value, blurred by a Gaussian and read at the pixel centres: the kernel is integrated over every pixel, so
/// a Gaussian much narrower than a pixel leaves the picture as it is and no width loses light. Beyond the border the border's own values go on.
/// \param image one channel, finite \param sd_px standard deviation [px] > 0, any size \return the same size
/// The kernel is cut at 4 sd and sums to 1. From 6 px on the blur is worked out on a grid of cells of a third of sd (averaged in, cubic B-spline out,
/// their widths taken off the kernel's): edges are within 0.002 of their height, a single pixel may be drawn up to sd / 6 aside. Same bytes for any
/// number of threads.
RasterF pixel_blur(const RasterF& image, double sd_px, int threads);
}  // namespace venato::graphics
