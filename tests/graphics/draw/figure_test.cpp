#include "graphics/draw/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
namespace venato::graphics {
namespace {
int count(const Raster8& r, const Srgb8& c) {
  int n = 0;
  for (std::size_t k = 0; k < r.data.size(); k += 3) n += r.data[k] == c[0] && r.data[k + 1] == c[1] && r.data[k + 2] == c[2];
  return n;
}
TEST(Palette, EndsMiddleAndNan) {
  EXPECT_EQ(palette_colour(Palette::viridis, -1), (Srgb8{68, 1, 84}));
  EXPECT_EQ(palette_colour(Palette::viridis, 1), (Srgb8{253, 231, 37}));
  EXPECT_EQ(palette_colour(Palette::diverging, 0.5), (Srgb8{230, 230, 230}));
  EXPECT_EQ(palette_colour(Palette::grey, std::nan("")), (Srgb8{255, 255, 255}));
  double before = -1;  // viridis rises in lightness all the way
  for (int k = 0; k <= 100; ++k) {
    const double l = lab_from_srgb(palette_colour(Palette::viridis, k / 100.0)).l;
    EXPECT_GT(l, before - 0.05);  // rounding to samples
    before = l;
  }
}
TEST(Overlay, OnlyFirstOnlySecondBoth) {
  RasterF a(4, 1, 1, 1e-3), b = a;
  a.data = {0, 1, 0, 1};
  b.data = {0, 0, 1, 1};
  const Raster8 o = overlay(a, b);
  for (const auto& c : {kOverlayGround, kOverlayBody, kOverlayPrint, kOverlayBoth}) EXPECT_EQ(count(o, c), 1);
  EXPECT_EQ(o.at(1, 0, 0), kOverlayBody[0]);
}
TEST(DrawMap, HasThePictureTheBarAndTheScale) {
  RasterF v(300, 600, 1, 1e-3);
  for (int j = 0; j < 600; ++j)
    for (int i = 0; i < 300; ++i) v.at(i, j) = static_cast<float>(i) / 299;
  v.at(5, 5) = std::numeric_limits<float>::quiet_NaN();
  MapStyle style;
  style.title = "misfit";
  style.label = "misfit [mm]";
  style.low = 0;
  style.high = 1;
  const Raster8 f = draw_map(v, style);
  EXPECT_GT(f.width, 300 + 40);
  EXPECT_GT(f.height, 600 + 40);
  EXPECT_GE(count(f, palette_colour(Palette::viridis, 0)), 600 - 3);  // first column; the bar ends on it too
  EXPECT_EQ(draw_map(v, style).data, f.data);
  style.max_width_px = 100;
  EXPECT_LT(draw_map(v, style).height, 330);
}
TEST(DrawMap, AllNanAndConstantWork) {
  MapStyle style;
  style.label = "x [1]";
  EXPECT_FALSE(draw_map(RasterF(50, 50, 1, 1e-3, std::numeric_limits<float>::quiet_NaN()), style).empty());
  EXPECT_FALSE(draw_map(RasterF(50, 50, 1, 1e-3, 3.0f), style).empty());
  EXPECT_FALSE(draw_map(RasterF(1, 1, 1, 0, 3.0f), style).empty());
}
TEST(DrawSection, BottomIsDownAndThicknessToScale) {
  RasterF f(10, 2, 2, 1e-3);
  for (int i = 0; i < 10; ++i) f.at(i, 0, 0) = f.at(i, 1, 1) = 1;  // bottom layer powder 0
  const Srgb8 low{200, 10, 10}, high{10, 10, 200};
  const Raster8 s = draw_section(f, {low, high}, {"red", "blue"}, 0.6, 0.012, 5, "section", 600);
  // 12 mm x 5 at 1 px/mm: 60 px high, half of it each colour (the legend adds a little square).
  EXPECT_NEAR(count(s, low), 600 * 30, 200);
  EXPECT_NEAR(count(s, high), 600 * 30, 200);
  int first_low = -1, first_high = -1;
  for (int j = 0; j < s.height; ++j) {
    const Srgb8 c{s.at(300, j, 0), s.at(300, j, 1), s.at(300, j, 2)};
    if (c == low && first_low < 0) first_low = j;
    if (c == high && first_high < 0) first_high = j;
  }
  EXPECT_LT(first_high, first_low);
}
}  // namespace
}  // namespace venato::graphics
