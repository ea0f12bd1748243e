#pragma once
/// Pictures of grains and walls without a display: orthographic, shaded spheres with a depth buffer, see-through walls with their edges, caption,
/// scale bar. A software renderer into plain pixels; whoever may write image files writes them. One million grains take about a second.
#include <array>
#include <cstdint>
#include <string>
#include <vector>
#include "base/vec3.h"
#include "dem/case.h"

namespace venato::dem {

using Rgb = std::array<std::uint8_t, 3>;
struct RgbImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< [row][column][3], top row first, sRGB
  double m_per_px = 0;
  Rgb at(int column, int row) const {
    const std::size_t k = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column));
    return {rgb[k], rgb[k + 1], rgb[k + 2]};
  }
};

struct PictureGrain {
  Vec3 position_m;
  double radius_m;
  Rgb colour;
};
struct PictureScene {
  std::vector<PictureGrain> grains;
  std::vector<Triangle> walls;                     ///< where they are now; drawn see-through, edges dark
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();    ///< what is shown; grains whose centre is outside are left out (cuts), walls are cut to it
  std::string caption;                             ///< below the picture; may be empty
  std::string scale_title, scale_low, scale_high;  ///< colour scale in the caption line; empty title = none
};
struct PictureStyle {
  PictureView view = PictureView::front;
  int width_px = 900;
  int supersample = 2;   ///< >= 1: drawn so much larger, then averaged
  bool annotate = true;  ///< caption and scale bar
};
inline constexpr Rgb kPaper{255, 255, 255};

/// \throws UsageError for an empty region, a width outside [16, 8000] or a height that would be above 8000.
RgbImage render(const PictureScene& scene, const PictureStyle& style);

/// Colour of a powder (a cycle of 8 that colour-blind people can tell apart), and of v in [0, 1] (clamped; dark violet to yellow, rising in
/// lightness).
Rgb powder_colour(int species);
Rgb scale_colour(double v);

/// Letters of 5 x 7 pixels (ASCII; others as a box), `size` times as large; \return width in pixels.
int draw_text(RgbImage& image, int left, int top, const std::string& text, Rgb colour, int size);
int text_width(const std::string& text, int size);
}  // namespace venato::dem
