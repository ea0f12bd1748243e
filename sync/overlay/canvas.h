#pragma once
#include <string>
#include "graphics/raster/raster.h"
#include "sync/overlay/palette.h"
namespace venato::sync {

/// Drawing on an RGB raster. Positions are pixels from its top-left corner; everything is clipped.
void fill_box(graphics::Raster8& canvas, int x, int y, int width, int height, Rgb colour);
void paste(graphics::Raster8& canvas, const graphics::Raster8& picture, int x, int y);
void draw_line(graphics::Raster8& canvas, int x0, int y0, int x1, int y1, Rgb colour, int thickness = 1);
void draw_dot(graphics::Raster8& canvas, double x, double y, double radius, Rgb colour);
enum class Align { left, centre, right };
/// ASCII text, `y` = base line, `size_px` = height of a capital letter.
void draw_text(graphics::Raster8& canvas, const std::string& text, int x, int y, int size_px, Rgb colour, Align align = Align::left);
int text_width_px(const std::string& text, int size_px);

/// Round step of 1, 2 or 5 times a power of ten that gives at most `most` steps over `span`.
double round_step(double span, int most);
/// Frame, ticks and mm labels around a panel of `width` x `height` px at (x, y).
void draw_mm_axes(graphics::Raster8& canvas, int x, int y, int width, int height, double px_per_m, int size_px);
}  // namespace venato::sync
