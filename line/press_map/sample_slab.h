#pragma once
#include "graphics/raster/raster.h"
#include "line/products/slab.h"
namespace venato::line {

/// Powder fractions of the slab on a plane parallel to its face: channels = powders, sum 1, on the pixels of slab.belt_from_green_m.
/// depth -> mass coordinate by the column's own mass (uniform density over the thickness), linear between the middles of the mass layers (the outer
/// half layers take their layer's value), bilinear between belt columns. \param depth_m in [0, thickness], below the pressed face \param blur_sigma_m
/// Gaussian in the plane, mirror at the slab's edges; negative = slab.sigma_nonaffine_m, 0 = none \throws UsageError for a depth outside the slab,
/// WorkError where the bed is empty
graphics::RasterF sample_layer_fraction(const Slab& slab, double depth_m, double blur_sigma_m = -1, int threads = 1);

/// Vertical cut from green point (x0, y0) to (x1, y1): top row = face; square pixels of pitch_m (the last column and row may reach less than a pixel
/// beyond). \throws UsageError when the line leaves the slab or is shorter than a pixel
graphics::RasterF sample_section(const Slab& slab, double x0_m, double y0_m, double x1_m, double y1_m, double pitch_m);
}  // namespace venato::line
