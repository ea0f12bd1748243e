#include "graphics/seen/scielab.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "graphics/colour/srgb.h"
#include "graphics/seen/pixel_blur.h"
namespace venato::graphics {
namespace {
constexpr EyeChannel kAll[] = {EyeChannel::luminance, EyeChannel::red_green, EyeChannel::blue_yellow};

Raster8 two_colours(int width, int height, double pitch_m, const Srgb8& a, const Srgb8& b, const std::function<bool(int, int)>& is_a) {
  Raster8 out(width, height, 3, pitch_m);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      for (int c = 0; c < 3; ++c) out.at(i, j, c) = (is_a(i, j) ? a : b)[static_cast<std::size_t>(c)];
  return out;
}
RasterF xyz_picture(const Raster8& p) {
  RasterF out(p.width, p.height, 3, p.pitch_m);
  for (std::size_t k = 0; k < p.data.size(); k += 3) {
    const Xyz c = xyz_from_srgb({p.data[k], p.data[k + 1], p.data[k + 2]});
    out.data[k] = static_cast<float>(c.x), out.data[k + 1] = static_cast<float>(c.y), out.data[k + 2] = static_cast<float>(c.z);
  }
  return out;
}
double phi(double x) { return 0.5 * std::erfc(-x / M_SQRT2); }

TEST(PixelBlur, ImpulseIsTheGaussianIntegratedOverThePixel) {
  for (const double sd : {0.05, 0.3, 1.0, 4.0, 9.0, 20.0}) {
    RasterF f(401, 401, 1, 0.001);
    f.at(200, 200) = 1;
    const RasterF g = pixel_blur(f, sd, 2);
    double sum = 0, worst = 0, second = 0;
    for (int j = 0; j < 401; ++j)
      for (int i = 0; i < 401; ++i) {
        const double want = (phi((i - 199.5) / sd) - phi((i - 200.5) / sd)) * (phi((j - 199.5) / sd) - phi((j - 200.5) / sd));
        sum += g.at(i, j);
        second += g.at(i, j) * (i - 200.0) * (i - 200.0);
        worst = std::max(worst, std::abs(g.at(i, j) - want));
      }
    EXPECT_NEAR(sum, 1, 1e-4) << sd;  // float sums over up to 80 000 pixels; where a pixel lies in its cell moves nothing
    // Sampled at pixel centres a Gaussian below a pixel has lost its moments. Cut at 4 sd: 0.1 % of the variance. On cells a pixel stands in its
    // cell's middle, up to sd / 6 away each way: that squared, and a sixth of the steepest slope in each direction.
    if (sd >= 1) {
      EXPECT_NEAR(second, sd * sd + 1.0 / 12, (sd < 6 ? 0.003 : 0.04) * sd * sd) << sd;
    }
    EXPECT_LT(worst, (sd < 6 ? 0.0005 : 2 * 0.61 / 6) / (2 * M_PI * sd * sd + 1)) << sd;
  }
}

/// An edge anywhere, within the promised 0.002.
TEST(PixelBlur, EdgeIsTheErrorFunction) {
  for (const double sd : {0.2, 2.0, 6.1, 10.0, 27.0, 53.0})
    for (const int at : {300, 301, 305}) {
      RasterF f(700, 8, 1, 0.001);
      for (int j = 0; j < 8; ++j)
        for (int i = at; i < 700; ++i) f.at(i, j) = 1;
      const RasterF g = pixel_blur(f, sd, 2);
      for (int i = 0; i < 700; ++i) ASSERT_NEAR(g.at(i, 3), phi((i + 0.5 - at) / sd), 0.002) << sd << " edge " << at << " pixel " << i;
    }
}

TEST(PixelBlur, BorderGoesOnAndConstantsStay) {
  RasterF f(37, 23, 1, 0.001, 0.7f);
  for (const double sd : {0.1, 3.0, 40.0})
    for (const float v : pixel_blur(f, sd, 2).data) ASSERT_NEAR(v, 0.7, 1e-6);
  // A ramp across depends on x; beyond the border it goes on at 36 and 0, so the mean of the ends stays.
  for (int j = 0; j < 23; ++j)
    for (int i = 0; i < 37; ++i) f.at(i, j) = static_cast<float>(i);
  const RasterF g = pixel_blur(f, 20, 2);
  for (int i = 0; i < 37; ++i) ASSERT_NEAR(g.at(i, 0) + g.at(36 - i, 22), 36, 0.02);  // cells of 6 do not divide 37: the border is placed to 0.1 px
}

TEST(EyeBlur, EveryChannelKeepsLightAtEveryScale) {
  for (const EyeChannel c : kAll)
    for (const double distance : {0.25, 0.5, 1.0, 2.0}) {
      RasterF f(1201, 1201, 1, 0.002);  // 2.4 m: the widest Gaussian at 2 m reaches 0.43 m
      f.at(600, 600) = 1;
      double sum = 0;
      const RasterF g = eye_blur(f, c, distance, 2);
      for (const float v : g.data) sum += static_cast<double>(v);
      EXPECT_NEAR(sum, 1, 1e-3) << static_cast<int>(c) << " at " << distance;
    }
}

/// The published spread is that of exp(-r^2/s^2). At a fine pitch the middle of a line (a row of pixels of width p) reads p sum w / (sqrt(pi) s);
/// with exp(-r^2/2s^2) it would read 0.707 of it.
TEST(EyeBlur, SpreadIsThatOfTheReferenceImplementation) {
  const double pitch = 0.00005, degree = std::tan(M_PI / 180);  // 50 um, 1 m
  RasterF f(400, 3, 1, pitch);
  for (int j = 0; j < 3; ++j) f.at(200, j) = 1;
  double want = 0;
  for (const auto& [w, s] : {std::pair(0.531, 0.0392), std::pair(0.330, 0.494)}) want += w / (0.531 + 0.330) * pitch / (std::sqrt(M_PI) * s * degree);
  EXPECT_NEAR(eye_blur(f, EyeChannel::red_green, 1.0, 2).at(200, 1) / want, 1, 0.01);
}

TEST(Scielab, UniformPatchesReadPlainDeltaE2000) {
  const Srgb8 a{120, 112, 104}, b{238, 180, 40};
  const auto all = [](int, int) { return true; };
  const RasterF x = xyz_picture(two_colours(90, 60, 0.001, a, a, all)), y = xyz_picture(two_colours(90, 60, 0.001, b, b, all));
  for (const double distance : {0.0, 0.5, 2.0}) {
    const RasterF d = delta_e2000(lab_seen_from(x, distance, 2), lab_seen_from(y, distance, 2), 2);
    const double want = delta_e2000(lab_from_srgb(a), lab_from_srgb(b));
    ASSERT_GT(want, 10);
    for (const float v : d.data) ASSERT_NEAR(v, want, 2e-4) << distance;  // float samples
    for (const float v : delta_e2000(lab_seen_from(x, distance, 2), lab_seen_from(x, distance, 2), 2).data) ASSERT_EQ(v, 0);
  }
}

TEST(Scielab, FineChequerFarAwayIsItsMeanInLinearLight) {
  const Srgb8 a{200, 60, 40}, b{40, 120, 220};
  const RasterF chequer = xyz_picture(two_colours(300, 300, 0.001, a, b, [](int i, int j) { return (i + j) % 2 == 0; }));
  const Xyz p = xyz_from_srgb(a), q = xyz_from_srgb(b);
  const Lab mean = lab_from_xyz({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
  double before = 1e9;
  for (const double distance : {0.5, 1.0, 2.0, 4.0, 8.0}) {
    const RasterF seen = lab_seen_from(chequer, distance, 2);
    double worst = 0;
    for (int j = 100; j < 200; ++j)
      for (int i = 100; i < 200; ++i) worst = std::max(worst, delta_e2000(mean, Lab{seen.at(i, j, 0), seen.at(i, j, 1), seen.at(i, j, 2)}));
    EXPECT_LT(worst, before) << distance;
    before = worst;
  }
  EXPECT_LT(before, 0.01);  // 8 m: the narrowest Gaussian has 2.8 px
  const RasterF plain = lab_seen_from(chequer, 0, 2);
  EXPECT_GT(delta_e2000(mean, Lab{plain.at(150, 150, 0), plain.at(150, 150, 1), plain.at(150, 150, 2)}), 10);  // control: the eye's blur does it
}

/// Grey on white has nearly no red-green to blur: hardly a coloured fringe. With the sign that the paper prints for Z a dark line turns deep green.
TEST(Scielab, GreyLinesStayGrey) {
  const RasterF x = xyz_picture(two_colours(200, 40, 0.001, {110, 110, 110}, {240, 240, 240}, [](int i, int) { return i >= 96 && i < 104; }));
  const RasterF seen = lab_seen_from(x, 1, 2);
  // 26 is the model's own fringe (white is not quite neutral in its space); with the other sign it is 111.
  for (int i = 0; i < 200; ++i) EXPECT_LT(std::hypot(seen.at(i, 20, 1), seen.at(i, 20, 2)), 30) << i;
}

TEST(Scielab, SameBytesForAnyThreads) {
  const RasterF x = xyz_picture(two_colours(333, 217, 0.001, {200, 60, 40}, {40, 120, 220}, [](int i, int j) { return (i * 7 + j * 3) % 11 < 4; }));
  const RasterF one = lab_seen_from(x, 1, 1), three = lab_seen_from(x, 1, 3);
  EXPECT_EQ(one.data, three.data);
}
}  // namespace
}  // namespace venato::graphics
