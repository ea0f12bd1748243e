#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sync/overlay/canvas.h"
#include "sync/overlay/overlay.h"
#include "sync/overlay/palette.h"
namespace venato::sync {
namespace {
constexpr int kMaxPanelWidth_px = 480, kMaxPanelHeight_px = 960, kText_px = 11, kTitle_px = 14, kMargin_px = 60, kGap_px = 70, kBand_px = 34;

graphics::Raster8 panel(const graphics::RasterF& map, double limit) {
  const int k = std::max({1, (map.width + kMaxPanelWidth_px - 1) / kMaxPanelWidth_px, (map.height + kMaxPanelHeight_px - 1) / kMaxPanelHeight_px});
  graphics::Raster8 out((map.width + k - 1) / k, (map.height + k - 1) / k, 3, map.pitch_m * k);
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i) {
      float most = 0;
      for (int y = j * k; y < std::min(map.height, (j + 1) * k); ++y)
        for (int x = i * k; x < std::min(map.width, (i + 1) * k); ++x) most = std::max(most, map.at(x, y));
      const Rgb colour = viridis(std::min(1.0, static_cast<double>(most) / limit));
      for (int c = 0; c < 3; ++c) out.at(i, j, c) = colour[static_cast<std::size_t>(c)];
    }
  return out;
}
std::string text(const char* format, double a, double b) {
  char out[160];
  std::snprintf(out, sizeof out, format, a, b);
  return out;
}
}  // namespace

graphics::Raster8 visibility_figure(const std::vector<Visibility>& seen, double limit) {
  VENATO_EXPECTS(!seen.empty() && limit > 0);
  std::vector<graphics::Raster8> panels;
  for (const Visibility& v : seen) panels.push_back(panel(v.delta_e, limit));
  const int wide = panels.front().width, high = panels.front().height, step = std::max(wide, 200) + kGap_px, n = static_cast<int>(panels.size());
  constexpr int bar_width = 18, bar_room = 110;
  graphics::Raster8 canvas(2 * kMargin_px + n * step - kGap_px + bar_room, 2 * kBand_px + high + 90, 3, 0, 255);
  draw_text(canvas, "colour difference (CIEDE2000 after S-CIELAB) that the misfit of print and body shows from a distance", kMargin_px, kBand_px - 12,
            kTitle_px, kInk);
  for (int k = 0; k < n; ++k) {
    const int x = kMargin_px + k * step, y = 2 * kBand_px;
    const auto at = static_cast<std::size_t>(k);
    paste(canvas, panels[at], x, y);
    draw_mm_axes(canvas, x, y, wide, high, 1 / panels[at].pitch_m, kText_px);
    draw_text(canvas, text("from %g m", seen[at].distance_m, 0), x, y - 10, kTitle_px, kInk);
    draw_text(canvas, text("visible: %.0f of %.0f mm", seen[at].visible_length_m() * 1e3, seen[at].print_length_m * 1e3), x, y + high + 64, kText_px,
              kInk);
  }
  const int x = kMargin_px + n * step - kGap_px + 30, bar = std::min(high, 320), y = 2 * kBand_px;
  for (int k = 0; k < bar; ++k) fill_box(canvas, x, y + bar - 1 - k, bar_width, 1, viridis((k + 0.5) / bar));
  const double tick = round_step(limit, 5);
  for (int k = 0; k * tick <= limit * (1 + 1e-9); ++k)
    draw_text(canvas, text("%g", k * tick, 0), x + bar_width + 8, y + bar - static_cast<int>(std::lround(k * tick / limit * bar)) + kText_px / 2,
              kText_px, kInk);
  return canvas;
}
}  // namespace venato::sync
