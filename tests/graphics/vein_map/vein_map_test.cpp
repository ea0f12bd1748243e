#include "graphics/vein_map/vein_map.h"

#include <gtest/gtest.h>
namespace venato::graphics {
namespace {
VeinMap three_powders() {
  VeinMap map;
  map.powders = {"grey", "white", "brown"};
  map.colours = {{0, 0, 0}, {255, 255, 255}, {120, 60, 20}};
  map.body_powder = 1;
  map.fraction = RasterF(2, 1, 3, 1e-3);
  map.fraction.data = {0.5f, 0.5f, 0.0f, 0.25f, 0.5f, 0.25f};
  return map;
}
TEST(VeinMap, VeinFractionIsAllButTheBody) {
  const RasterF v = vein_fraction(three_powders());
  EXPECT_EQ(v.channels, 1);
  EXPECT_EQ(v.pitch_m, 1e-3);
  EXPECT_EQ(v.data, (std::vector<float>{0.5f, 0.5f}));
}
TEST(VeinMap, ColoursMixInLinearLight) {
  const Raster8 p = colour_preview(three_powders());
  // Half the light of sRGB white is 188 (IEC 61966-2-1: 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354), not 128.
  EXPECT_EQ(p.at(0, 0, 0), 188);
  EXPECT_EQ(p.at(0, 0, 1), 188);
  EXPECT_EQ(p.at(0, 0, 2), 188);
  EXPECT_GT(p.at(1, 0, 0), p.at(1, 0, 2));  // brown adds red
}
TEST(VeinMap, PurePowderKeepsItsColour) {
  VeinMap map = three_powders();
  map.fraction.data = {0, 0, 1, 0, 1, 0};
  const Raster8 p = colour_preview(map);
  EXPECT_EQ(p.data, (std::vector<std::uint8_t>{120, 60, 20, 255, 255, 255}));
}
}  // namespace
}  // namespace venato::graphics
