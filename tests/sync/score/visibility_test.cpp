#include "sync/score/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.h"
namespace venato::sync {
namespace {
using graphics::Raster8;
using graphics::RasterF;

constexpr PrintColours kMarble{{120, 112, 104}, {238, 235, 228}, 0};

Raster8 draw(int width, int height, const std::function<bool(double, double)>& inside, double pitch_m = 0.001) {
  Raster8 m(width, height, 1, pitch_m);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) m.at(i, j) = inside(i + 0.5, j + 0.5) ? 255 : 0;
  return m;
}
/// Vein along x, 6 mm wide, in the middle of 400 x 300 mm, moved by `shift_mm`.
Raster8 vein(double shift_mm) {
  return draw(400, 300, [=](double, double y) { return std::abs(y - 150 - shift_mm) < 3; });
}
std::vector<Visibility> seen(const Raster8& body, const Raster8& print, const PrintColours& colours = kMarble) {
  return visibility(body, {&print}, colours, 2)[0];
}

TEST(Visibility, NothingIsSeenOfAPrintThatFits) {
  for (const Visibility& v : seen(vein(0), vein(0))) {
    for (const float d : v.delta_e.data) ASSERT_EQ(d, 0);
    EXPECT_EQ(v.delta_e_mean, 0);
    EXPECT_EQ(v.delta_e_p95, 0);
    EXPECT_EQ(v.area_over_1, 0);
    EXPECT_EQ(v.visible_length_m(), 0);
    EXPECT_GT(v.print_length_m, 0.35);
  }
}

TEST(Visibility, NothingIsSeenOfAVeinInTheGroundsColour) {
  const PrintColours plain{{200, 190, 180}, {200, 190, 180}, 0};
  for (const Visibility& v : seen(vein(0), vein(5), plain)) {
    for (const float d : v.delta_e.data) ASSERT_NEAR(d, 0, 1e-4);
    EXPECT_EQ(v.visible_length_m() + v.missing_length_m, 0);
  }
}

/// A wide body half of which the print misses: far from every edge the difference is the plain one of both colours, close to it less.
TEST(Visibility, WideMisfitReadsThePlainColourDifference) {
  const Raster8 body = draw(1200, 1200, [](double, double) { return true; }), print(1200, 1200, 1, 0.001);
  const double plain = graphics::delta_e2000(graphics::lab_from_srgb(kMarble.vein), graphics::lab_from_srgb(kMarble.ground));
  for (const Visibility& v : seen(body, print)) {
    EXPECT_NEAR(v.delta_e_mean, plain, 1e-3);
    EXPECT_NEAR(v.delta_e_p95, plain, 1e-3);
    EXPECT_EQ(v.area_over_2, 1);
  }
}

TEST(Visibility, ALargerDistanceNeverShowsMoreOfASmallShift) {
  for (const double shift : {1.0, 2.0}) {
    const auto v = seen(vein(0), vein(shift));
    ASSERT_EQ(v.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(v[k].distance_m, (std::vector<double>{0.5, 1, 2})[k]);
    for (std::size_t k = 1; k < 3; ++k) {
      EXPECT_LT(v[k].delta_e_mean, v[k - 1].delta_e_mean) << shift;
      EXPECT_LT(v[k].delta_e_p95, v[k - 1].delta_e_p95) << shift;
      EXPECT_LE(v[k].visible_length_m(), v[k - 1].visible_length_m()) << shift;
    }
  }
  // A larger shift shows more, at every distance.
  const auto one = seen(vein(0), vein(1)), three = seen(vein(0), vein(3));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(three[k].delta_e_mean, one[k].delta_e_mean);
}

TEST(Visibility, VisibleLengthCountsWhatIsMovedMissingAndExtra) {
  // Left half of the vein 3 mm off, right half right.
  const Raster8 half = draw(400, 300, [](double x, double y) { return std::abs(y - 150 - (x < 200 ? 3 : 0)) < 3; });
  for (const Visibility& v : seen(vein(0), half)) {
    EXPECT_NEAR(v.displaced_length_m, 0.2, 0.012) << v.distance_m;  // the step itself and the shortened end
    EXPECT_NEAR(v.extra_length_m, 0, 0.005);                        // the slanted links of the step find no partner
    EXPECT_NEAR(v.missing_length_m, 0, 0.005);
  }
  const Raster8 short_vein = draw(400, 300, [](double x, double y) { return x < 200 && std::abs(y - 150) < 3; });
  for (const Visibility& v : seen(vein(0), short_vein)) {
    EXPECT_EQ(v.visible_length_m(), 0);
    EXPECT_NEAR(v.missing_length_m, 0.2, 0.012);
  }
  for (const Visibility& v : seen(short_vein, vein(0))) {
    EXPECT_NEAR(v.extra_length_m, 0.2, 0.012);
    EXPECT_EQ(v.displaced_length_m, 0);
    EXPECT_EQ(v.missing_length_m, 0);
  }
}

/// Colours that differ by little: the shift is there, the eye does not notice it. And a print that is only wider is not displaced.
TEST(Visibility, FaintVeinsAndWidthsAreNotVisibleLength) {
  const PrintColours faint{{236, 233, 226}, {238, 235, 228}, 0};
  for (const Visibility& v : seen(vein(0), vein(3), faint)) {
    EXPECT_EQ(v.visible_length_m(), 0);
    EXPECT_GT(v.delta_e_mean, 0);
  }
  const Raster8 wide = draw(400, 300, [](double, double y) { return std::abs(y - 150) < 6; });
  for (const Visibility& v : seen(vein(0), wide)) {
    EXPECT_EQ(v.visible_length_m(), 0);
    EXPECT_GT(v.area_over_2, 0);  // but the map shows it
  }
  // 0.4 mm between the lines: more than 1 arcmin at 0.5 and 1 m, less at 2 m (0.58 mm).
  const Raster8 a = draw(
                    4000, 60, [](double, double y) { return std::abs(y - 30) < 8; }, 0.0002),
                b = draw(
                    4000, 60, [](double, double y) { return std::abs(y - 32) < 8; }, 0.0002);
  const auto v = seen(a, b);
  EXPECT_GT(v[0].visible_length_m(), 0.7);
  EXPECT_EQ(v[2].visible_length_m(), 0);
}

TEST(PrintColoursOfAGraphic, AreMeansInLinearLight) {
  RasterF fraction(10, 10, 1, 0.002);
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 5; ++i) fraction.at(i, j) = 1;
  Raster8 picture(20, 20, 3, 0.001);
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 20; ++i)
      for (int c = 0; c < 3; ++c) picture.at(i, j, c) = i < 10 ? (j % 2 ? 0 : 255) : 200;
  const auto colours = print_colours(picture, fraction);
  ASSERT_TRUE(colours);
  EXPECT_EQ(colours->vein, (graphics::Srgb8{188, 188, 188}));  // half the light of white
  EXPECT_EQ(colours->ground, (graphics::Srgb8{200, 200, 200}));
  EXPECT_NEAR(colours->delta_e, graphics::delta_e2000(graphics::lab_from_srgb({188, 188, 188}), graphics::lab_from_srgb({200, 200, 200})), 1e-12);
  EXPECT_FALSE(print_colours(picture, RasterF(10, 10, 1, 0.002)));
  EXPECT_FALSE(print_colours(picture, RasterF(10, 10, 1, 0.002, 1.0f)));
  EXPECT_FALSE(print_colours({}, fraction));
}

TEST(Visibility, RefusesWhatItCannotCompare) {
  const Raster8 other(400, 299, 1, 0.001);
  EXPECT_THROW(seen(vein(0), other), UsageError);
  VisibilityConfig config;
  config.distances_m = {0};
  const Raster8 v = vein(0);
  EXPECT_THROW(visibility(v, {&v}, kMarble, 2, config), UsageError);
}

TEST(Visibility, EmptyMasksReadNoNumber) {
  const Raster8 nothing(40, 30, 1, 0.001);
  for (const Visibility& v : seen(nothing, nothing)) {
    EXPECT_TRUE(std::isnan(v.delta_e_mean));
    EXPECT_TRUE(std::isnan(v.delta_e_p95));
    EXPECT_EQ(v.visible_length_m(), 0);
  }
}
}  // namespace
}  // namespace venato::sync
