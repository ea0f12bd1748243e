#include "graphics/draw/figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "graphics/draw/canvas.h"
#include "graphics/raster/resample.h"
namespace venato::graphics {
namespace {
using detail::TextSize;
constexpr int kMargin = 14, kTitleBand = 34, kFootBand = 34, kBarWidth = 16, kTicks = 5;

struct Layout {
  Raster8 canvas;
  int x = kMargin, y = kMargin;  ///< of the picture's corner
};
/// White sheet with the title above, room for `right` px beside and a foot below.
Layout sheet(const Raster8& picture, const std::string& title, int right, int foot) {
  Layout l;
  if (!title.empty()) l.y = kTitleBand;
  const int width = std::max(picture.width + right, detail::text_width(title, TextSize::title)) + 2 * kMargin;
  l.canvas = Raster8(width, l.y + picture.height + foot + kMargin, 3, 0, 255);
  if (!title.empty()) detail::draw_text(l.canvas, title, kMargin, kTitleBand - 12, TextSize::title);
  // Thin frame, so that a light picture ends visibly on white paper.
  detail::fill_rectangle(l.canvas, l.x - 1, l.y - 1, picture.width + 2, picture.height + 2, {190, 190, 190});
  detail::paste(l.canvas, picture, l.x, l.y);
  return l;
}
int legend_width(const std::vector<LegendEntry>& legend) {
  int w = 0;
  for (const auto& e : legend) w += 14 + 6 + detail::text_width(e.text, TextSize::small) + 18;
  return w;
}
void draw_legend(Raster8& canvas, const std::vector<LegendEntry>& legend, int x, int y) {
  for (const auto& e : legend) {
    detail::fill_rectangle(canvas, x - 1, y - 1, 16, 14, {150, 150, 150});
    detail::fill_rectangle(canvas, x, y, 14, 12, e.colour);
    detail::draw_text(canvas, e.text, x + 20, y + 11, TextSize::small);
    x += 14 + 6 + detail::text_width(e.text, TextSize::small) + 18;
  }
}
Raster8 with_frame(const Raster8& picture, double width_m, const std::string& title, const std::vector<LegendEntry>& legend) {
  const bool scale = width_m > 0;
  const int foot = (scale ? kFootBand : 0) + (legend.empty() ? 0 : kFootBand - 8);
  Layout l = sheet(picture, title, std::max(0, legend_width(legend) - picture.width), foot);
  int y = l.y + picture.height + 12;
  if (scale) {
    detail::draw_scale_bar(l.canvas, picture.width / width_m, width_m, l.x, y + 4);
    y += kFootBand - 8;
  }
  draw_legend(l.canvas, legend, l.x, y);
  return l.canvas;
}
/// Quantiles of the finite values; symmetric about 0 for a diverging palette.
void choose_range(const RasterF& values, const MapStyle& style, double& low, double& high) {
  low = style.low;
  high = style.high;
  if (low != high) return;
  std::vector<float> finite;
  for (float v : values.data)
    if (std::isfinite(v)) finite.push_back(v);
  if (finite.empty()) {
    high = low + 1;
    return;
  }
  std::sort(finite.begin(), finite.end());
  const auto at = [&](double q) { return static_cast<double>(finite[static_cast<std::size_t>(q * static_cast<double>(finite.size() - 1))]); };
  low = at(0.01);
  high = at(0.99);
  if (style.palette == Palette::diverging) {
    high = std::max(std::abs(low), std::abs(high));
    low = -high;
  }
  if (!(high > low)) high = low + std::max(1e-12, std::abs(low) * 1e-3);
}
/// Area average that leaves NaN pixels out (a pixel without any value stays NaN).
RasterF reduce(const RasterF& values, int width) {
  if (values.width <= width) return values;
  RasterF sum = values, weight(values.width, values.height, 1, values.pitch_m, 1.0f);
  for (std::size_t k = 0; k < sum.data.size(); ++k)
    if (!std::isfinite(sum.data[k])) sum.data[k] = weight.data[k] = 0;
  sum = shrink_to_width(sum, width);
  weight = shrink_to_width(weight, width);
  for (std::size_t k = 0; k < sum.data.size(); ++k)
    sum.data[k] = weight.data[k] > 0 ? sum.data[k] / weight.data[k] : std::numeric_limits<float>::quiet_NaN();
  return sum;
}
}  // namespace

Raster8 draw_map(const RasterF& values, const MapStyle& style) {
  VENATO_EXPECTS(values.channels == 1 && !values.empty());
  const RasterF small = reduce(values, style.max_width_px);
  double low = 0, high = 1;
  choose_range(small, style, low, high);
  Raster8 picture(small.width, small.height, 3, small.pitch_m);
  for (std::size_t k = 0; k < small.data.size(); ++k) {
    const Srgb8 c = palette_colour(style.palette, (small.data[k] - low) / (high - low));
    std::copy(c.begin(), c.end(), picture.data.begin() + static_cast<std::ptrdiff_t>(3 * k));
  }
  const int bar_height = std::clamp(picture.height, 120, 400);
  int tick_width = detail::text_width(style.label, TextSize::small);
  for (int t = 0; t < kTicks; ++t)
    tick_width =
        std::max(tick_width, kBarWidth + 10 + detail::text_width(detail::short_number(low + (high - low) * t / (kTicks - 1)), TextSize::small));
  const int foot = std::max(kFootBand, bar_height + 30 - picture.height);
  Layout l = sheet(picture, style.title, 24 + tick_width, foot);
  const int x = l.x + picture.width + 24, top = l.y + 24;
  detail::draw_text(l.canvas, style.label, x, l.y + 10, TextSize::small);
  for (int j = 0; j < bar_height - 24; ++j)
    detail::fill_rectangle(l.canvas, x, top + j, kBarWidth, 1, palette_colour(style.palette, 1 - static_cast<double>(j) / (bar_height - 25)));
  for (int t = 0; t < kTicks; ++t) {
    const int y = top + (bar_height - 25) * (kTicks - 1 - t) / (kTicks - 1);
    detail::fill_rectangle(l.canvas, x + kBarWidth, y, 4, 1, detail::kInkColour);
    detail::draw_text(l.canvas, detail::short_number(low + (high - low) * t / (kTicks - 1)), x + kBarWidth + 8, y + 5, TextSize::small);
  }
  if (values.pitch_m > 0) detail::draw_scale_bar(l.canvas, picture.width / values.width_m(), values.width_m(), l.x, l.y + picture.height + 16);
  return l.canvas;
}

Raster8 draw_picture(const Raster8& srgb, const std::string& title, const std::vector<LegendEntry>& legend, int max_width_px) {
  VENATO_EXPECTS(srgb.channels == 1 || srgb.channels == 3);
  Raster8 small = shrink_to_width(srgb, max_width_px);
  if (small.channels == 1) {
    Raster8 rgb(small.width, small.height, 3, small.pitch_m);
    for (std::size_t k = 0; k < rgb.data.size(); ++k) rgb.data[k] = small.data[k / 3];
    small = std::move(rgb);
  }
  return with_frame(small, srgb.width_m(), title, legend);
}

Raster8 overlay(const RasterF& body_vein, const RasterF& print_vein) {
  VENATO_EXPECTS(body_vein.width == print_vein.width && body_vein.height == print_vein.height && body_vein.channels == 1 && print_vein.channels == 1);
  Raster8 out(body_vein.width, body_vein.height, 3, body_vein.pitch_m);
  for (std::size_t k = 0; k < body_vein.data.size(); ++k) {
    const float a = std::clamp(body_vein.data[k], 0.0f, 1.0f), b = std::clamp(print_vein.data[k], 0.0f, 1.0f), both = std::min(a, b);
    for (std::size_t c = 0; c < 3; ++c) {
      const float v =
          both * kOverlayBoth[c] + (a - both) * kOverlayBody[c] + (b - both) * kOverlayPrint[c] + (1 - std::max(a, b)) * kOverlayGround[c];
      out.data[3 * k + c] = static_cast<std::uint8_t>(v + 0.5f);
    }
  }
  return out;
}

Raster8 draw_overlay(const RasterF& body_vein, const RasterF& print_vein, const std::string& title, const std::string& body_label,
                     const std::string& print_label, int max_width_px) {
  return draw_picture(overlay(body_vein, print_vein), title, {{body_label, kOverlayBody}, {print_label, kOverlayPrint}, {"both", kOverlayBoth}},
                      max_width_px);
}

Raster8 draw_section(const RasterF& fraction, const std::vector<Srgb8>& powder_colours, const std::vector<std::string>& powder_names, double length_m,
                     double thickness_m, double z_exaggeration, const std::string& title, int width_px) {
  VENATO_EXPECTS(static_cast<std::size_t>(fraction.channels) == powder_colours.size() && powder_names.size() == powder_colours.size());
  VENATO_EXPECTS(length_m > 0 && thickness_m > 0 && z_exaggeration > 0 && width_px > 0);
  const int height_px = std::max(8, static_cast<int>(std::lround(width_px / length_m * thickness_m * z_exaggeration)));
  Raster8 picture(width_px, height_px, 3, 0);
  std::vector<LegendEntry> legend;
  for (std::size_t p = 0; p < powder_names.size(); ++p) legend.push_back({powder_names[p], powder_colours[p]});
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) {
      const int i = static_cast<int>((x + 0.5) / width_px * fraction.width),
                j = static_cast<int>((height_px - y - 0.5) / height_px * fraction.height);
      double sum[3] = {}, total = 0;
      for (int p = 0; p < fraction.channels; ++p) {
        const double w = std::max(0.0f, fraction.at(i, j, p));
        total += w;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += w * srgb_to_linear(powder_colours[static_cast<std::size_t>(p)][c]);
      }
      for (int c = 0; c < 3; ++c) picture.at(x, y, c) = total > 0 ? linear_to_srgb(sum[c] / total) : 255;
    }
  std::string full = title + " (height x " + detail::short_number(z_exaggeration) + ")";
  return with_frame(picture, length_m, z_exaggeration == 1 ? title : full, legend);
}
}  // namespace venato::graphics
