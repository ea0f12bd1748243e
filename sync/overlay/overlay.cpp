#include "sync/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "graphics/raster/resample.h"
#include "sync/overlay/canvas.h"
#include "sync/overlay/palette.h"

namespace venato::sync {
namespace {

constexpr int kMaxPanelHeight_px = 1200, kMaxPanelWidth_px = 900, kMinPanelSide_px = 360;
constexpr int kText_px = 11, kTitle_px = 14, kMargin_px = 60, kGap_px = 70, kBand_px = 34;

/// Shrinks (area average: lines fade instead of vanishing) or enlarges (whole factor) to a readable size.
graphics::Raster8 to_figure_size(const graphics::Raster8& panel) {
  const int shrink =
      std::max({1, (panel.height + kMaxPanelHeight_px - 1) / kMaxPanelHeight_px, (panel.width + kMaxPanelWidth_px - 1) / kMaxPanelWidth_px});
  if (shrink > 1) return graphics::shrink(panel, shrink);
  const int grow = std::min(kMinPanelSide_px / std::max(1, std::max(panel.width, panel.height)), 16);
  if (grow < 2) return panel;
  graphics::Raster8 out(panel.width * grow, panel.height * grow, panel.channels, panel.pitch_m / grow);
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i)
      for (int c = 0; c < out.channels; ++c) out.at(i, j, c) = panel.at(i / grow, j / grow, c);
  return out;
}

graphics::Raster8 paper(int width, int height) { return graphics::Raster8(width, height, 3, 0, 255); }

int draw_key(graphics::Raster8& canvas, int x, int y, Rgb colour, const std::string& label) {
  fill_box(canvas, x, y - kText_px - 1, 18, kText_px + 3, colour);
  draw_text(canvas, label, x + 24, y, kText_px, kInk);
  return x + 24 + text_width_px(label, kText_px) + 26;
}

std::string mm_text(double mm) {
  char text[32];
  std::snprintf(text, sizeof text, "%g mm", mm);
  return text;
}

void draw_scale_bar(graphics::Raster8& canvas, int right, int y, double px_per_m) {
  const double length_mm = round_step(1e3 * 150 / px_per_m, 1);
  const int length = static_cast<int>(std::lround(length_mm * px_per_m / 1e3));
  fill_box(canvas, right - length, y - 5, length, 4, kInk);
  draw_text(canvas, mm_text(length_mm), right - length - 10, y, kText_px, kInk, Align::right);
}

}  // namespace

graphics::Raster8 overlay_panel(const graphics::Raster8& body, const graphics::Raster8& print) {
  VENATO_EXPECTS(print.empty() || (print.width == body.width && print.height == body.height));
  graphics::Raster8 out(body.width, body.height, 3, body.pitch_m);
  for (std::size_t k = 0; k < body.data.size(); ++k) {
    const bool vein = body.data[k] != 0, ink = !print.empty() && print.data[k] != 0;
    const Rgb& colour = vein && ink ? kBothColour : vein ? kBodyColour : ink ? kPrintColour : kGroundColour;
    std::copy(colour.begin(), colour.end(), out.data.begin() + static_cast<std::ptrdiff_t>(3 * k));
  }
  return out;
}

graphics::Raster8 overlay_figure(const graphics::Raster8& body, const graphics::Raster8& before, const graphics::Raster8& after,
                                 const OverlayTexts& texts) {
  const graphics::Raster8 left = to_figure_size(overlay_panel(body, before));
  const graphics::Raster8 right = after.empty() ? graphics::Raster8{} : to_figure_size(overlay_panel(body, after));
  const double px_per_m = 1 / left.pitch_m;
  const int panels = right.empty() ? 1 : 2, top = kBand_px;
  const int needed = panels * left.width + (panels - 1) * kGap_px + 2 * kMargin_px;
  const int keys = 2 * kMargin_px + text_width_px(texts.body_label + texts.print_label + texts.both_label, kText_px) + 3 * 50 + 260;
  const int width = std::max({needed, keys, 2 * kMargin_px + text_width_px(texts.note, kText_px)});
  const int legend = top + left.height + 64, height = legend + (texts.note.empty() ? 16 : 16 + kBand_px);
  graphics::Raster8 canvas = paper(width, height);
  for (int k = 0; k < panels; ++k) {
    const int x = kMargin_px + k * (left.width + kGap_px);
    paste(canvas, k ? right : left, x, top);
    draw_mm_axes(canvas, x, top, left.width, left.height, px_per_m, kText_px);
    draw_text(canvas, k ? texts.right_title : texts.left_title, x + left.width / 2, top - 12, kTitle_px, kInk, Align::centre);
  }
  int x = kMargin_px;
  x = draw_key(canvas, x, legend, kBodyColour, texts.body_label);
  x = draw_key(canvas, x, legend, kPrintColour, texts.print_label);
  draw_key(canvas, x, legend, kBothColour, texts.both_label);
  draw_scale_bar(canvas, width - kMargin_px, legend, px_per_m);
  if (!texts.note.empty()) draw_text(canvas, texts.note, kMargin_px, legend + kBand_px - 4, kText_px, kInk);
  return canvas;
}

graphics::Raster8 misfit_figure(const graphics::Raster8& body, const std::vector<ResidualSample>& samples, double limit_m, const std::string& title) {
  graphics::Raster8 ground(body.width, body.height, 3, body.pitch_m);
  for (std::size_t k = 0; k < body.data.size(); ++k) {
    const Rgb& colour = body.data[k] ? kFaintVein : kGroundColour;
    std::copy(colour.begin(), colour.end(), ground.data.begin() + static_cast<std::ptrdiff_t>(3 * k));
  }
  ground = to_figure_size(ground);
  const double px_per_m = 1 / ground.pitch_m;
  for (const ResidualSample& s : samples)
    draw_dot(ground, s.x_m * px_per_m - 0.5, s.y_m * px_per_m - 0.5, 1.6,
             s.matched ? viridis(std::abs(s.signed_distance_m) / limit_m) : kUnmatchedColour);

  constexpr int bar_width = 18, bar_room = 150;
  const int width = std::max(2 * kMargin_px + ground.width + bar_room, 2 * kMargin_px + text_width_px(title, kTitle_px));
  graphics::Raster8 canvas = paper(width, kBand_px + ground.height + 90);
  paste(canvas, ground, kMargin_px, kBand_px);
  draw_mm_axes(canvas, kMargin_px, kBand_px, ground.width, ground.height, px_per_m, kText_px);
  draw_text(canvas, title, kMargin_px, kBand_px - 12, kTitle_px, kInk);
  const int bar_x = kMargin_px + ground.width + 40, bar_height = std::min(ground.height, 320);
  for (int k = 0; k < bar_height; ++k) fill_box(canvas, bar_x, kBand_px + bar_height - 1 - k, bar_width, 1, viridis((k + 0.5) / bar_height));
  const double step_mm = round_step(limit_m * 1e3, 5);
  for (int k = 0; k * step_mm <= limit_m * 1e3 * (1 + 1e-9); ++k) {
    const int y = kBand_px + bar_height - static_cast<int>(std::lround(k * step_mm / (limit_m * 1e3) * bar_height));
    draw_line(canvas, bar_x + bar_width, y, bar_x + bar_width + 4, y, kInk);
    draw_text(canvas, mm_text(k * step_mm), bar_x + bar_width + 8, y + kText_px / 2, kText_px, kInk);
  }
  int x = kMargin_px;
  x = draw_key(canvas, x, kBand_px + ground.height + 64, kFaintVein, "body vein");
  draw_key(canvas, x, kBand_px + ground.height + 64, kUnmatchedColour, "print vein without body vein");
  return canvas;
}

}  // namespace venato::sync
