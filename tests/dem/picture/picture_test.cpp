#include "dem/picture/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"

namespace venato::dem {
namespace {
const Rgb kRed{200, 0, 0}, kBlue{0, 0, 200};

PictureScene empty_scene() {
  PictureScene s;
  s.low = Vec3::Constant(-0.01), s.high = Vec3::Constant(0.01);
  return s;
}
PictureStyle plain(PictureView view = PictureView::front, int width = 400, int supersample = 1) { return {view, width, supersample, false}; }

template <class Is>
int count(const RgbImage& image, Is is) {
  int n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) n += is(image.at(x, y));
  return n;
}
bool is_paper(const Rgb& c) { return c == kPaper; }
bool reddish(const Rgb& c) { return c[0] > 40 && c[1] == 0 && c[2] == 0; }
bool bluish(const Rgb& c) { return c[2] > 40 && c[1] == 0 && c[0] == 0; }

TEST(Picture, a_sphere_covers_its_disc_wherever_one_looks_from) {
  PictureScene s = empty_scene();
  const double radius = 0.004;
  s.grains = {{Vec3(0.001, -0.002, 0.003), radius, kRed}};
  for (const PictureView view : {PictureView::front, PictureView::side, PictureView::top, PictureView::oblique}) {
    const RgbImage image = render(s, plain(view));
    const double px = radius / image.m_per_px, area = std::numbers::pi * px * px;
    // Centres of pixels inside a circle: the number differs from the area by less than the border's length of pixels; 2 pi r / 10 is generous.
    EXPECT_NEAR(count(image, reddish), area, 0.2 * std::numbers::pi * px) << static_cast<int>(view);
    EXPECT_EQ(count(image, reddish) + count(image, is_paper), image.width * image.height);
  }
}
TEST(Picture, a_sphere_lies_where_its_projection_does) {
  PictureScene s = empty_scene();
  s.grains = {{Vec3(0.004, -0.006, 0.002), 0.001, kRed}};
  const auto middle = [&](PictureView view) {
    const RgbImage image = render(s, plain(view));
    double x = 0, y = 0, n = 0;
    for (int j = 0; j < image.height; ++j)
      for (int i = 0; i < image.width; ++i)
        if (reddish(image.at(i, j))) x += i + 0.5, y += j + 0.5, n += 1;
    return std::pair((x / n - 0.5 * image.width) * image.m_per_px * 1e3, (0.5 * image.height - y / n) * image.m_per_px * 1e3);
  };
  const double half_px = 0.03;  // mm
  EXPECT_NEAR(middle(PictureView::front).first, 4, half_px);
  EXPECT_NEAR(middle(PictureView::front).second, 2, half_px);
  EXPECT_NEAR(middle(PictureView::side).first, -6, half_px);
  EXPECT_NEAR(middle(PictureView::side).second, 2, half_px);
  EXPECT_NEAR(middle(PictureView::top).first, 4, half_px);
  EXPECT_NEAR(middle(PictureView::top).second, -6, half_px);
}
TEST(Picture, the_nearer_grain_hides_the_farther_in_any_order) {
  PictureScene s = empty_scene();
  const PictureGrain red{Vec3(0, -0.005, 0), 0.002, kRed}, blue{Vec3(0, 0.005, 0), 0.002, kBlue};
  for (const bool swapped : {false, true}) {
    s.grains = swapped ? std::vector{blue, red} : std::vector{red, blue};
    const RgbImage front = render(s, plain());  // the viewer is at -y: red is nearer
    EXPECT_GT(count(front, reddish), 0);
    EXPECT_EQ(count(front, bluish), 0);
  }
  std::swap(s.grains[0].position_m, s.grains[1].position_m);
  EXPECT_EQ(count(render(s, plain()), reddish), 0);
}
TEST(Picture, a_cut_leaves_out_grains_outside) {
  PictureScene s = empty_scene();
  s.grains = {{Vec3(0, -0.005, 0), 0.002, kRed}, {Vec3(0, 0.005, 0), 0.002, kBlue}};
  s.low.y() = 0;
  const RgbImage cut = render(s, plain());
  EXPECT_EQ(count(cut, reddish), 0);
  EXPECT_GT(count(cut, bluish), 0);
}
TEST(Picture, grains_below_a_pixel_are_still_seen) {
  PictureScene s = empty_scene();
  s.grains = {{Vec3(0.0012345, 0, 0.0012345), 1e-7, kRed}};
  EXPECT_EQ(count(render(s, plain()), reddish), 1);
}
TEST(Picture, walls_tint_what_is_behind_them_and_hide_nothing) {
  PictureScene s = empty_scene();
  s.grains = {{Vec3(0, 0, 0), 0.003, kRed}};
  const auto wall_at = [](double y) {
    return std::vector<Triangle>{{Vec3(-0.008, y, -0.008), Vec3(0.008, y, -0.008), Vec3(0.008, y, 0.008)},
                                 {Vec3(-0.008, y, -0.008), Vec3(0.008, y, 0.008), Vec3(-0.008, y, 0.008)}};
  };
  const Rgb bare = render(s, plain()).at(200, 200);
  s.walls = wall_at(-0.006);  // in front
  const RgbImage front = render(s, plain());
  EXPECT_NE(front.at(200, 200), bare);
  EXPECT_GT(front.at(200, 200)[0], 100);  // still red
  s.walls = wall_at(0.006);               // behind
  const RgbImage behind = render(s, plain());
  EXPECT_EQ(behind.at(200, 200), bare);
  EXPECT_NE(behind.at(80, 80), kPaper);  // tint of the wall beside the grain
  EXPECT_EQ(behind.at(10, 10), kPaper);  // outside the wall
  // Its border is drawn, the diagonal between its two coplanar triangles is not: the tint is even along any line inside.
  const auto column = [&](int x) { return behind.at(x, 100); };
  for (int x = 60; x < 340; ++x) EXPECT_EQ(column(x), column(60)) << x;
}
TEST(Picture, an_empty_case_is_paper_and_bad_requests_are_refused) {
  const RgbImage image = render(empty_scene(), plain());
  EXPECT_EQ(count(image, is_paper), image.width * image.height);
  EXPECT_EQ(image.width, 400);
  PictureScene flat = empty_scene();
  flat.high = flat.low;
  EXPECT_THROW(render(flat, plain()), UsageError);
  EXPECT_THROW(render(empty_scene(), plain(PictureView::front, 9000)), UsageError);
  EXPECT_THROW(render(empty_scene(), plain(PictureView::front, 400, 0)), UsageError);
  PictureScene tower = empty_scene();
  tower.high.z() = 10;
  EXPECT_THROW(render(tower, plain()), UsageError);
}
TEST(Picture, caption_and_scale_bar_stand_below) {
  PictureScene s = empty_scene();
  s.caption = "t = 0.5 s";
  const RgbImage bare = render(s, plain()), full = render(s, {PictureView::front, 400, 1, true});
  ASSERT_GT(full.height, bare.height);
  int ink = 0, longest = 0;
  for (int y = bare.height; y < full.height; ++y) {
    int run = 0;
    for (int x = 0; x < full.width; ++x) {
      const bool dark = full.at(x, y)[0] < 100;
      ink += dark, run = dark ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  EXPECT_GT(ink, 50);
  // 20.8 mm wide with margins: a fifth is 4.16 mm, the bar 2 mm.
  EXPECT_NEAR(longest * full.m_per_px, 2e-3, full.m_per_px);
  for (int y = 0; y < bare.height; ++y)
    for (int x = 0; x < bare.width; ++x) ASSERT_EQ(full.at(x, y), bare.at(x, y));
}
TEST(Picture, letters_are_there_and_differ) {
  const auto pixels_of = [](const std::string& text) {
    RgbImage image{40, 10, std::vector<std::uint8_t>(1200, 255), 1};
    draw_text(image, 1, 1, text, {0, 0, 0}, 1);
    return image.rgb;
  };
  for (char c = 33; c < 126; ++c) EXPECT_NE(pixels_of(std::string(1, c)), pixels_of(std::string(1, static_cast<char>(c + 1)))) << c;
  EXPECT_EQ(pixels_of("\xc3"), pixels_of("\x01"));  // not ASCII: a box
  RgbImage tiny{3, 3, std::vector<std::uint8_t>(27, 255), 1};
  EXPECT_EQ(draw_text(tiny, -4, -4, "cut off", {0, 0, 0}, 2), text_width("cut off", 2));  // stays inside the image
}
TEST(Colours, scale_ends_and_order) {
  EXPECT_EQ(scale_colour(0), (Rgb{68, 1, 84}));
  EXPECT_EQ(scale_colour(1), (Rgb{253, 231, 37}));
  EXPECT_EQ(scale_colour(-3), scale_colour(0));
  EXPECT_EQ(scale_colour(7), scale_colour(1));
  EXPECT_EQ(scale_colour(std::nan("")), scale_colour(0));
  double before = -1;
  for (int k = 0; k <= 100; ++k) {
    const Rgb c = scale_colour(0.01 * k);
    const double lightness = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    EXPECT_GT(lightness, before) << k;
    before = lightness;
  }
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < a; ++b) EXPECT_NE(powder_colour(a), powder_colour(b));
  EXPECT_EQ(powder_colour(8), powder_colour(0));
}
TEST(Picture, a_hundred_thousand_grains_take_well_under_a_second) {
  PictureScene s = empty_scene();
  Rng rng(1, 1);
  for (int k = 0; k < 100000; ++k)
    s.grains.push_back({Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5) * 0.02, 1.5e-4, powder_colour(k)});
  const std::clock_t start = std::clock();  // of this process: a busy machine does not count
  const RgbImage image = render(s, {PictureView::front, 900, 2, true});
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  RecordProperty("seconds", std::to_string(seconds));
  // Measured 0.3 s of processor time; a slow machine takes some times that, a quadratic algorithm a thousand times.
  EXPECT_LT(seconds, 5);
  EXPECT_LT(count(image, is_paper), image.width * image.height / 5);
}
}  // namespace
}  // namespace venato::dem
