#include "graphics/raster/resample.h"

#include <gtest/gtest.h>

#include <numeric>
namespace venato::graphics {
namespace {
TEST(Resample, ShrinkAveragesBlocks) {
  Raster8 r(4, 2, 2, 1e-3);
  for (std::size_t k = 0; k < r.data.size(); ++k) r.data[k] = static_cast<std::uint8_t>(10 * k);
  const Raster8 s = shrink(r, 2);
  EXPECT_EQ(s.width, 2);
  EXPECT_EQ(s.height, 1);
  EXPECT_DOUBLE_EQ(s.pitch_m, 2e-3);
  // Channel 0 of the left block: 0, 20, 80, 100 -> 50; channel 1: 60; right block 90, 100.
  EXPECT_EQ(s.data, (std::vector<std::uint8_t>{50, 60, 90, 100}));
}
TEST(Resample, LastColumnAveragesWhatIsThere) {
  RasterF r(5, 1, 1, 1.0);
  r.data = {0, 2, 4, 6, 8};
  const RasterF s = shrink(r, 2);
  EXPECT_EQ(s.data, (std::vector<float>{1, 5, 8}));
}
TEST(Resample, ShrinkToWidthKeepsMeanAndFrame) {
  RasterF r(101, 203, 1, 0.5e-3);
  for (int j = 0; j < r.height; ++j)
    for (int i = 0; i < r.width; ++i) r.at(i, j) = static_cast<float>((i * 7 + j * 13) % 50);
  const RasterF s = shrink_to_width(r, 40);
  EXPECT_EQ(s.width, 40);
  EXPECT_NEAR(s.width_m(), r.width_m(), 1e-12);
  EXPECT_NEAR(s.height_m(), r.height_m(), s.pitch_m / 2);  // the height is rounded to whole pixels
  const auto mean = [](const RasterF& x) { return std::accumulate(x.data.begin(), x.data.end(), 0.0) / static_cast<double>(x.data.size()); };
  // Every source pixel has the same weight except in the last row, which the rounding of the height clips: 1 of 80 rows, contrast 50.
  EXPECT_NEAR(mean(s), mean(r), 0.3);
}
TEST(Resample, ConstantStaysConstantAndNothingIsEnlarged) {
  const Raster8 r(37, 19, 3, 1e-3, 201);
  for (int w : {1, 5, 36}) {
    const Raster8 s = shrink_to_width(r, w);
    for (auto v : s.data) ASSERT_EQ(v, 201);
  }
  EXPECT_EQ(shrink_to_width(r, 100).data, r.data);
  EXPECT_EQ(shrink_to_width(r, 100).width, 37);
}
TEST(Resample, CropTakesTheRectangle) {
  Raster8 r(6, 5, 1, 1e-3);
  std::iota(r.data.begin(), r.data.end(), std::uint8_t{0});
  EXPECT_EQ(crop(r, 2, 1, 3, 2).data, (std::vector<std::uint8_t>{8, 9, 10, 14, 15, 16}));
  EXPECT_EQ(channel(Raster8(2, 1, 2, 1e-3, 9), 1).data, (std::vector<std::uint8_t>{9, 9}));
}
}  // namespace
}  // namespace venato::graphics
