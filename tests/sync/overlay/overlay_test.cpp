#include "sync/overlay/overlay.h"

#include <gtest/gtest.h>

#include "graphics/graphic.h"
#include "sync/overlay/canvas.h"
#include "sync/overlay/palette.h"

namespace venato::sync {
namespace {

Rgb pixel(const graphics::Raster8& image, int i, int j) { return {image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2)}; }

graphics::Raster8 column(int width, int height, int from, int to) {
  graphics::Raster8 mask(width, height, 1, 0.001);
  for (int j = 0; j < height; ++j)
    for (int i = from; i < to; ++i) mask.at(i, j) = 255;
  return mask;
}

std::size_t count(const graphics::Raster8& image, Rgb colour) {
  std::size_t n = 0;
  for (int j = 0; j < image.height; ++j)
    for (int i = 0; i < image.width; ++i) n += pixel(image, i, j) == colour;
  return n;
}

TEST(Overlay, PanelTellsBodyPrintAndBothApart) {
  const auto panel = overlay_panel(column(40, 10, 5, 15), column(40, 10, 10, 20));
  EXPECT_EQ(pixel(panel, 2, 3), kGroundColour);
  EXPECT_EQ(pixel(panel, 7, 3), kBodyColour);
  EXPECT_EQ(pixel(panel, 12, 3), kBothColour);
  EXPECT_EQ(pixel(panel, 17, 3), kPrintColour);
  EXPECT_EQ(count(overlay_panel(column(40, 10, 5, 15), {}), kBodyColour), 100u);
}

TEST(Overlay, FigureHoldsBothPanelsAndALegend) {
  const auto body = column(400, 600, 100, 120), before = column(400, 600, 140, 160), after = column(400, 600, 101, 121);
  const auto figure = overlay_figure(body, before, after, {});
  EXPECT_GE(figure.width, 2 * 400);
  // Left: nothing overlaps, 2 x 20 columns. Right: 19 columns overlap. The legend adds less than 5 %.
  EXPECT_NEAR(static_cast<double>(count(figure, kBothColour)), 19 * 600, 0.05 * 19 * 600);
  EXPECT_NEAR(static_cast<double>(count(figure, kPrintColour)), 21 * 600, 0.05 * 21 * 600);
  EXPECT_GT(count(figure, kBothColour), 19u * 600u) << "the legend's key";
  const auto single = overlay_figure(body, before, {}, {.left_title = "as placed", .note = "not registered: no pose"});
  EXPECT_LT(single.width, figure.width);
  EXPECT_EQ(overlay_figure(body, before, after, {}).data, figure.data) << "same input, same bytes";
}

TEST(Overlay, MisfitColoursFollowTheDistance) {
  const auto body = column(400, 300, 100, 120);
  std::vector<ResidualSample> samples;
  for (int k = 0; k < 100; ++k) samples.push_back({0.11, 0.05 + 0.002 * k, 0.0, true});
  for (int k = 0; k < 100; ++k) samples.push_back({0.21, 0.05 + 0.002 * k, -0.009, true});  // sign does not matter, beyond the limit saturates
  for (int k = 0; k < 100; ++k) samples.push_back({0.31, 0.05 + 0.002 * k, 0.0, false});
  const auto figure = misfit_figure(body, samples, 0.005);
  EXPECT_GT(count(figure, viridis(0)), 300u);
  EXPECT_GT(count(figure, viridis(1)), 300u);
  EXPECT_GT(count(figure, kUnmatchedColour), 300u);
}

TEST(Overlay, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(600, 12), 50);
  EXPECT_DOUBLE_EQ(round_step(1200, 12), 100);
  EXPECT_DOUBLE_EQ(round_step(5, 5), 1);
  EXPECT_DOUBLE_EQ(round_step(0.3, 4), 0.1);
}

}  // namespace
}  // namespace venato::sync
