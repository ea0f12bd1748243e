#pragma once
#include "graphics/raster/raster.h"
namespace venato::graphics {

/// Area average over factor x factor pixels (never point sampling: print data is dithered). The last row and column average what is there,
/// so the picture may end up to factor - 1 source pixels before the new raster does. pitch * factor.
RasterF shrink(const RasterF& image, int factor);
Raster8 shrink(const Raster8& image, int factor);  ///< rounded to nearest
/// Area average to at most `width` pixels across, any ratio; square pixels kept. Never enlarges: a narrower picture comes back as it is.
Raster8 shrink_to_width(const Raster8& image, int width);
RasterF shrink_to_width(const RasterF& image, int width);
/// Sub-rectangle; must lie inside. Same pitch.
Raster8 crop(const Raster8& image, int x, int y, int width, int height);
RasterF crop(const RasterF& image, int x, int y, int width, int height);
/// One channel.
RasterF channel(const RasterF& image, int c);
Raster8 channel(const Raster8& image, int c);
}  // namespace venato::graphics
