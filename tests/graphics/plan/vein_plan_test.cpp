#include "graphics/plan/vein_plan.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "graphics/graphic.h"
#include "graphics/raster/mask.h"
#include "graphics/raster/resample.h"
namespace venato::graphics {
namespace {
const std::vector<std::string> kPowders = {"white", "grey", "brown"};

/// Body of lightness falling slowly across, with one straight vein of the given width through the centre at `angle`.
Raster8 picture_with_vein(double width_m, double angle_rad, std::uint8_t vein, double pitch_m = 1e-3, int size = 400) {
  Raster8 r(size, size, 3, pitch_m);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      const double x = (i + 0.5 - size / 2.0) * pitch_m, y = (j + 0.5 - size / 2.0) * pitch_m;
      const double across = std::abs(x * std::cos(angle_rad) + y * std::sin(angle_rad));
      const double cover = std::clamp((width_m / 2 - across) / pitch_m + 0.5, 0.0, 1.0);
      const double body = 235 - 25.0 * i / size;
      for (int c = 0; c < 3; ++c) r.at(i, j, c) = static_cast<std::uint8_t>(std::lround(body * (1 - cover) + vein * cover));
    }
  return r;
}
RasterF vein_of(const VeinPlan& plan, int vein) { return channel(plan.fraction, vein); }

/// Width of the vein across the middle row times cos(angle) and its centre [m], from the coverage.
struct Crossing {
  double width_m = 0, centre_m = 0;
};
Crossing cross(const RasterF& v, int row, double angle_rad) {
  double sum = 0, moment = 0;
  for (int i = 0; i < v.width; ++i) {
    sum += v.at(i, row);
    moment += v.at(i, row) * (i + 0.5);
  }
  return {sum * v.pitch_m * std::cos(angle_rad), sum > 0 ? moment / sum * v.pitch_m : 0};
}

TEST(VeinPlan, ChannelsSumToOneAndOnlyTwoPowdersAreUsed) {
  const VeinPlan plan = plan_veins(picture_with_vein(0.02, 0.3, 60), {}, kPowders, 0, 2);
  EXPECT_EQ(plan.powders, kPowders);
  EXPECT_EQ(plan.body_powder, 0);
  EXPECT_EQ(plan.fraction.channels, 3);
  double veins = 0;
  for (std::size_t k = 0; k < plan.fraction.data.size(); k += 3) {
    ASSERT_EQ(plan.fraction.data[k] + plan.fraction.data[k + 1] + plan.fraction.data[k + 2], 1.0f);
    ASSERT_EQ(plan.fraction.data[k + 1], 0.0f);
    ASSERT_GE(plan.fraction.data[k + 2], 0.0f);
    veins += plan.fraction.data[k + 2];
  }
  EXPECT_GT(veins, 0);
}

TEST(VeinPlan, WideVeinKeepsWidthAndPlace) {
  for (const double angle : {0.0, 0.3, -0.7})
    for (const double width : {0.015, 0.03}) {
      VeinPlanConfig config;
      config.darkness_threshold = 0.30;  // about half the contrast of 235 against 60: the threshold crosses the true edge
      const RasterF v = vein_of(plan_veins(picture_with_vein(width, angle, 60), config, kPowders, 0, 1), 1);
      for (const int row : {120, 200, 280}) {
        const Crossing c = cross(v, row, angle);
        const double y = (row + 0.5 - 200) * 1e-3;
        // Threshold not exactly at half contrast (body lightness varies 10 %): up to 0.8 mm on both edges together at a 2 mm smoothing.
        EXPECT_NEAR(c.width_m, width, 1.0e-3) << angle;
        EXPECT_NEAR(c.centre_m, 0.2 - y * std::tan(angle), 0.4e-3) << angle;
      }
    }
}

TEST(VeinPlan, NarrowVeinIsWidenedToTheMinimum) {
  for (const double angle : {0.0, 0.4, -0.7})
    for (const double min_width : {0.008, 0.012}) {
      VeinPlanConfig config;
      config.min_width_m = min_width;
      const RasterF v = vein_of(plan_veins(picture_with_vein(0.003, angle, 40), config, kPowders, 0, 1), 1);
      for (int row = 0; row < 400; row += 19) {  // from border to border
        const Crossing c = cross(v, row, angle);
        // The centre line is a staircase of whole pixels, up to half a pixel off the axis on either side, and the discs along it are united:
        // up to one pixel (1 mm) too wide (measured +0.83 mm), never narrower than the smoothing of the outline makes it. Within a vein's
        // width of the border the vein is continued straight out: min_width across the rows there, its centre held back by up to tan/4 of it.
        const bool border = row < 8 || row >= 392;
        EXPECT_LT(c.width_m, min_width + (border ? 1.3e-3 : 1.0e-3)) << angle << " row " << row;
        EXPECT_GT(c.width_m, min_width * (border ? std::cos(angle) : 1) - 0.3e-3) << angle << " row " << row;
        EXPECT_NEAR(c.centre_m, 0.2 - (row + 0.5 - 200) * 1e-3 * std::tan(angle), 0.8e-3 + (border ? min_width / 4 * std::abs(std::tan(angle)) : 0))
            << angle << " row " << row;
      }
    }
}

TEST(VeinPlan, SpecksHairlinesAndSlowShadeAreLeftOut) {
  Raster8 r(400, 400, 1, 1e-3);
  for (int j = 0; j < 400; ++j)
    for (int i = 0; i < 400; ++i) {
      double v = 230 - 60.0 * i / 400;                   // slow shade: 60 of 255 over the width
      if (std::hypot(i - 100.0, j - 100.0) < 6) v = 60;  // speck of 113 mm2
      if (i == 250) v -= 60;                             // hairline of 1 mm
      r.at(i, j) = static_cast<std::uint8_t>(v);
    }
  const RasterF none = vein_of(plan_veins(r, {}, kPowders, 0, 1), 1);
  for (float v : none.data) ASSERT_EQ(v, 0.0f);
  VeinPlanConfig config;
  config.min_area_m2 = 0.5e-4;  // now the speck is wanted
  const RasterF speck = vein_of(plan_veins(r, config, kPowders, 0, 1), 1);
  EXPECT_EQ(speck.at(100, 100), 1.0f);
  EXPECT_EQ(speck.at(250, 300), 0.0f);
}

TEST(VeinPlan, FinePicturesGiveAPlanOfAboutAMillimetre) {
  const VeinPlan fine = plan_veins(picture_with_vein(0.02, 0.3, 60, 0.25e-3, 1600), {}, kPowders, 0, 1);
  EXPECT_EQ(fine.fraction.width, 400);
  EXPECT_NEAR(fine.fraction.pitch_m, 1e-3, 1e-12);
  const VeinPlan same = plan_veins(picture_with_vein(0.02, 0.3, 60, 1e-3, 400), {}, kPowders, 0, 1);
  double difference = 0;
  for (std::size_t k = 0; k < same.fraction.data.size(); ++k) difference += std::abs(same.fraction.data[k] - fine.fraction.data[k]);
  // The two pictures differ by their rounding only; a quarter of a millimetre on both edges of 420 mm of vein would be 210 pixels, x 2 channels.
  EXPECT_LT(difference, 400);
}

TEST(VeinPlan, LighterVeins) {
  Raster8 r = picture_with_vein(0.02, 0.3, 60);
  for (auto& v : r.data) v = static_cast<std::uint8_t>(255 - v);
  VeinPlanConfig config;
  const RasterF dark = vein_of(plan_veins(r, config, kPowders, 0, 1), 1);
  EXPECT_EQ(dark.at(200, 200), 0.0f);
  config.tone = VeinTone::lighter;
  const RasterF light = vein_of(plan_veins(r, config, kPowders, 0, 1), 1);
  EXPECT_EQ(light.at(200, 200), 1.0f);
}

/// The example picture: long veins in one piece, at least 8 mm wide everywhere, no small bits.
TEST(VeinPlan, ExamplePictureGivesContinuousVeins) {
  const Raster8 picture = load_picture(std::filesystem::path(VENATO_SOURCE_DIR) / "configs/images/pov_calacatta_1600x3200.jpg", 1e-3).pixels;
  const VeinPlan plan = plan_veins(crop(picture, 500, 1000, 600, 1200), {}, kPowders, 0, 1);
  const RasterF v = vein_of(plan, 1);
  Raster8 mask(v.width, v.height, 1, v.pitch_m);
  double area = 0;
  for (std::size_t k = 0; k < v.data.size(); ++k) {
    mask.data[k] = v.data[k] >= 0.5f ? 255 : 0;
    area += v.data[k];
  }
  area /= static_cast<double>(v.data.size());
  EXPECT_GT(area, 0.02);  // few long veins: 3.5 % when looked at
  EXPECT_LT(area, 0.06);
  // Centre lines away from ends and the border have 4 mm on either side, less the half pixel of sampling and 0.3 mm of smoothing in bends.
  const RasterF inside = signed_distance(mask);
  const Raster8 line = thin(mask);
  int length = 0, narrow = 0;
  for (int j = 10; j < v.height - 10; ++j)
    for (int i = 10; i < v.width - 10; ++i)
      if (line.at(i, j)) {
        ++length;
        float best = 0;
        for (int y = -4; y <= 4; ++y)
          for (int x = -4; x <= 4; ++x) best = std::max(best, inside.at(i + x, j + y));
        narrow += best < 3.2f;
      }
  EXPECT_GT(length, 1500);  // two veins that cross the crop
  EXPECT_EQ(narrow, 0);
  EXPECT_EQ(without_small_parts(mask, 300).data, mask.data);
  // The long vein reaches the bottom from the left border in one piece: at most four pieces in all.
  EXPECT_NE(without_small_parts(mask, 5000).data, Raster8(v.width, v.height, 1, v.pitch_m).data);
}

TEST(VeinPlan, SameBytesForAnyThreads) {
  const Raster8 r = picture_with_vein(0.006, 0.5, 60);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const VeinPlan a = plan_veins(r, {}, kPowders, 0, 1);
  omp_set_num_threads(4);
  const VeinPlan b = plan_veins(r, {}, kPowders, 0, 1);
  omp_set_num_threads(before);
  EXPECT_EQ(a.fraction.data, b.fraction.data);
}

TEST(VeinPlan, BadInputIsRefused) {
  EXPECT_THROW(plan_veins(Raster8(10, 10, 3, 0), {}, kPowders, 0, 1), UsageError);
  VeinPlanConfig config;
  config.min_width_m = std::nan("");
  EXPECT_THROW(plan_veins(Raster8(10, 10, 3, 1e-3), config, kPowders, 0, 1), UsageError);
}
}  // namespace
}  // namespace venato::graphics
