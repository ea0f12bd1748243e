#pragma once
/// Drawing on a Raster8 (RGB). Internal to graphics/draw.
#include <string>
#include "graphics/colour/srgb.h"
#include "graphics/raster/raster.h"
namespace venato::graphics::detail {

inline constexpr Srgb8 kInkColour{30, 30, 30};
enum class TextSize { small, title };
int text_width(const std::string& text, TextSize size);
int text_height(TextSize size);
/// \param x left end \param baseline of the letters
void draw_text(Raster8& image, const std::string& text, int x, int baseline, TextSize size);
void fill_rectangle(Raster8& image, int x, int y, int width, int height, Srgb8 colour);
void paste(Raster8& image, const Raster8& part, int x, int y);  ///< must fit
/// A bar of a round length (1, 2, 5 x 10^n mm) of about a fifth of `width_m`, with its length below. \return width used in px
int draw_scale_bar(Raster8& image, double px_per_m, double width_m, int x, int y);
std::string short_number(double v);  ///< "%.3g"
}  // namespace venato::graphics::detail
