#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include "base/error.h"
#include "base/rng.h"
#include "graphics/colour/ink_model.h"
#include "graphics/graphic.h"
namespace venato::graphics {
namespace {
constexpr Srgb8 kBody{232, 229, 221};
const std::vector<Ink> kInks = {{"blue", {52, 84, 158}},    {"brown", {128, 78, 48}},  {"beige", {214, 188, 150}},
                                {"yellow", {222, 190, 82}}, {"pink", {206, 132, 128}}, {"black", {38, 37, 38}}};

Raster8 one(const Srgb8& c) {
  Raster8 r(1, 1, 3, 1e-3);
  std::copy(c.begin(), c.end(), r.data.begin());
  return r;
}
Srgb8 pixel(const Raster8& r, int i) { return {r.at(i, 0, 0), r.at(i, 0, 1), r.at(i, 0, 2)}; }

TEST(Separate, BodyColourAndLighterNeedNoInk) {
  for (const Srgb8 body : {kBody, Srgb8{180, 171, 160}, Srgb8{97, 103, 99}, Srgb8{255, 255, 255}}) {
    const Graphic g = separate(one(body), kInks, body);
    EXPECT_EQ(g.ink.data, std::vector<std::uint8_t>(6, 0));
    EXPECT_EQ(pixel(g.srgb, 0), body);
    EXPECT_TRUE(g.separated_without_profile);
  }
  EXPECT_EQ(separate(one({255, 255, 255}), kInks, kBody).ink.data, std::vector<std::uint8_t>(6, 0));
}

TEST(Separate, SolidsAreReproduced) {
  for (std::size_t k = 0; k < kInks.size(); ++k) {
    const Graphic g = separate(one(kInks[k].solid_srgb), kInks, kBody);
    // The table's cells are 8 samples wide: 3 levels of 255 between nodes at worst; the colour must agree below the visible difference.
    EXPECT_LT(delta_e2000(lab_from_srgb(pixel(g.srgb, 0)), lab_from_srgb(kInks[k].solid_srgb)), 1.0) << kInks[k].name;
    std::vector<std::uint8_t> full(6, 0);
    full[k] = 255;
    EXPECT_EQ(predict_srgb(kInks, kBody, full.data()), kInks[k].solid_srgb);
  }
}

TEST(Separate, BlackIsAsDarkAsTheInksCan) {
  const Graphic g = separate(one({0, 0, 0}), kInks, kBody, 2.4);
  EXPECT_EQ(g.ink.at(0, 0, 5), 255);
  EXPECT_LE(pixel(g.srgb, 0)[1], 38);
}

/// Random mixtures of up to three inks: in gamut by construction.
TEST(Separate, InGamutRoundTrip) {
  const int n = 4000;
  Raster8 in(n, 1, 3, 1e-3);
  Rng rng(7, stream_id("tests/graphics/separate"));
  for (int i = 0; i < n; ++i) {
    std::uint8_t amount[6] = {};
    for (int k = 0; k < 3; ++k) amount[rng.below(6)] = static_cast<std::uint8_t>(rng.below(200));
    const Srgb8 c = predict_srgb(kInks, kBody, amount);
    std::copy(c.begin(), c.end(), &in.at(i, 0));
  }
  const Graphic g = separate(in, kInks, kBody, 3.0);
  std::vector<double> de;
  for (int i = 0; i < n; ++i) de.push_back(delta_e2000(lab_from_srgb(pixel(in, i)), lab_from_srgb(pixel(g.srgb, i))));
  std::sort(de.begin(), de.end());
  RecordProperty("median", std::to_string(de[n / 2]));
  RecordProperty("p99", std::to_string(de[n * 99 / 100]));
  // Stated accuracy: median 0.5, 99 % below 2 (1 is the visible limit side by side); 8-bit inks and 8-sample cells make the rest.
  EXPECT_LT(de[n / 2], 0.5);
  EXPECT_LT(de[n * 99 / 100], 2.0);
}

TEST(Separate, LimitsHoldEverywhere) {
  const int n = 20000;
  Raster8 in(n, 1, 3, 1e-3);
  Rng rng(9, stream_id("tests/graphics/separate_limits"));
  for (auto& v : in.data) v = static_cast<std::uint8_t>(rng.below(256));
  for (const int most : {1, 2, 3})
    for (const double limit : {0.8, 1.5, 2.4}) {
      const Graphic g = separate(in, kInks, kBody, limit, most);
      for (int i = 0; i < n; ++i) {
        int used = 0, sum = 0;
        for (int k = 0; k < 6; ++k) {
          used += g.ink.at(i, 0, k) != 0;
          sum += g.ink.at(i, 0, k);
        }
        ASSERT_LE(used, most);
        ASSERT_LE(sum, limit * 255 + 3);  // rounding of up to three inks to 8 bit, at most half a level each (and of tetrahedra)
      }
    }
}

TEST(Separate, PreviewIsThePrediction) {
  Raster8 in(300, 1, 3, 1e-3);
  for (int i = 0; i < 300; ++i)
    for (int c = 0; c < 3; ++c) in.at(i, 0, c) = static_cast<std::uint8_t>(230 - i * (c + 1) / 5);
  const Graphic g = separate(in, kInks, kBody);
  for (int i = 0; i < 300; ++i) {
    const Srgb8 p = predict_srgb(kInks, kBody, &g.ink.at(i, 0));
    // Products of factors against the exponential of the sum: equal but for a rounding at a sample's border.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(g.srgb.at(i, 0, c), p[static_cast<std::size_t>(c)], 1);
  }
}

TEST(Separate, SameBytesForAnyThreads) {
  Raster8 in(64, 64, 3, 1e-3);
  Rng rng(11, stream_id("tests/graphics/separate_threads"));
  for (auto& v : in.data) v = static_cast<std::uint8_t>(rng.below(256));
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const Graphic a = separate(in, kInks, kBody);
  omp_set_num_threads(4);
  const Graphic b = separate(in, kInks, kBody);
  omp_set_num_threads(before);
  EXPECT_EQ(a.ink.data, b.ink.data);
  EXPECT_EQ(a.srgb.data, b.srgb.data);
}

TEST(SolveInks, AgreesWithProjectedGradient) {
  const InkModel model = make_ink_model(kInks, kBody);
  const std::vector<int> three = {0, 3, 5};
  Rng rng(3, stream_id("tests/graphics/solve_inks"));
  for (int trial = 0; trial < 200; ++trial) {
    Log3 target;
    for (auto& t : target) t = -3 * rng.uniform() + 0.3;
    const auto got = solve_inks(model, target, 1e9, 3, three);
    // Slow and obvious: cyclic coordinate descent on the box, convex, 4000 rounds.
    double a[3] = {};
    for (int round = 0; round < 4000; ++round)
      for (std::size_t k = 0; k < 3; ++k) {
        const Log3& v = model.absorb[static_cast<std::size_t>(three[k])];
        double num = -0.5e-4, den = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          double rest = target[c];
          for (std::size_t m = 0; m < 3; ++m)
            if (m != k) rest -= a[m] * model.absorb[static_cast<std::size_t>(three[m])][c];
          num += rest * v[c];
          den += v[c] * v[c];
        }
        a[k] = std::clamp(num / den, 0.0, 1.0);
      }
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(got[static_cast<std::size_t>(three[k])], a[k], 1e-6) << trial;
  }
}

TEST(Separate, RefusesWithoutInks) {
  EXPECT_THROW(separate(one(kBody), {}, kBody), UsageError);
  EXPECT_THROW(separate(one(kBody), kInks, kBody, 0.0), UsageError);
  EXPECT_THROW(separate(one(kBody), kInks, kBody, 2.4, 4), UsageError);
}
}  // namespace
}  // namespace venato::graphics
