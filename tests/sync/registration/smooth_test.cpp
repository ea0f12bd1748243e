#include <gtest/gtest.h>
#include <cmath>
#include "base/rng.h"
#include "sync/registration/gaussian.h"
#include "sync/registration/image_ops.h"
namespace venato::sync {
namespace {
Feature noise(int width, int height, double holes) {
  Feature f{graphics::RasterF(width, height, 1, 0.001), graphics::Raster8(width, height, 1, 0.001, 255)};
  Rng rng(1, stream_id("tests/sync/smooth"));
  for (std::size_t k = 0; k < f.value.data.size(); ++k) {
    f.value.data[k] = static_cast<float>(rng.uniform());
    if (rng.uniform() < holes) f.value.data[k] = f.valid.data[k] = 0;
  }
  return f;
}

TEST(Smooth, IsTheNormalisedMaskedGaussianSum) {
  for (const double holes : {0.0, 0.3}) {
    const Feature f = noise(70, 45, holes), s = smooth(f, 2.2, 2);
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(35, 20), std::pair(69, 44), std::pair(3, 41)}) {
      double sum = 0, weight = 0;
      for (int j = std::max(0, y - 8); j <= std::min(44, y + 8); ++j)  // 8 = cut at 3.5 sigma
        for (int i = std::max(0, x - 8); i <= std::min(69, x + 8); ++i) {
          const double w = f.valid.at(i, j) ? std::exp(-((i - x) * (i - x) + (j - y) * (j - y)) / (2 * 2.2 * 2.2)) : 0;
          sum += w * static_cast<double>(f.value.at(i, j));
          weight += w;
        }
      if (!f.valid.at(x, y)) continue;
      EXPECT_NEAR(static_cast<double>(s.value.at(x, y)), sum / weight, 2e-6);
    }
  }
}
TEST(Smooth, LeavesAConstantAndGivesTheSameBytesForAnyThreadCount) {
  Feature f = noise(301, 517, 0.1);
  for (const double sigma : {1.0, 7.9, 25.0}) {
    const Feature one = smooth(f, sigma, 1), four = smooth(f, sigma, 4);
    EXPECT_EQ(one.value.data, four.value.data);
    EXPECT_EQ(one.valid.data, four.valid.data);
    Feature flat = f;
    for (std::size_t k = 0; k < flat.value.data.size(); ++k) flat.value.data[k] = flat.valid.data[k] ? 0.75f : 0.0f;
    const Feature s = smooth_and_extend(flat, sigma, 2);
    for (std::size_t k = 0; k < s.value.data.size(); ++k) EXPECT_NEAR(s.value.data[k], s.valid.data[k] ? 0.75f : 0.0f, 1e-5f);
  }
}
}  // namespace
}  // namespace venato::sync
