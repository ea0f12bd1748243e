#include "sync/score/shape.h"
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include "sync/score/score.h"
namespace venato::sync {
namespace {
using graphics::Raster8;
using graphics::RasterF;

Raster8 stripes(double angle_deg, double offset = 0, double half_width = 3) {
  Raster8 m(240, 240, 1, 0.001);
  const double c = std::cos(angle_deg * M_PI / 180), s = std::sin(angle_deg * M_PI / 180);
  for (int j = 0; j < 240; ++j)
    for (int i = 0; i < 240; ++i) {
      const double across = -s * (i - 120) + c * (j - 120) - offset;
      m.at(i, j) = std::abs(across - 24 * std::round(across / 24)) <= half_width ? 255 : 0;
    }
  return m;
}

TEST(DirectionCoherence, RotatedStripesReadCosineOfTwiceTheAngle) {
  for (const double angle : {0.0, 10.0, 30.0, 45.0, 60.0, 90.0})
    // A stripe's binary edge places its own direction to about a degree: 0.04 of cos 2x at most.
    EXPECT_NEAR(direction_coherence(stripes(0), stripes(angle)), std::cos(2 * angle * M_PI / 180), 0.04) << angle;
  EXPECT_TRUE(std::isnan(direction_coherence(stripes(0, 0), stripes(0, 12))));  // no overlap
}

/// Straight vein of half width h whose edges are a Gaussian's integral.
RasterF soft_vein(double h_px, double sigma_px, double angle_deg = 0) {
  RasterF f(200, 200, 1, 0.001);
  const double c = std::cos(angle_deg * M_PI / 180), s = std::sin(angle_deg * M_PI / 180);
  for (int j = 0; j < 200; ++j)
    for (int i = 0; i < 200; ++i) {
      const double y = -s * (i - 99.5) + c * (j - 99.5);
      f.at(i, j) = static_cast<float>(0.5 * (std::erf((y + h_px) / (M_SQRT2 * sigma_px)) - std::erf((y - h_px) / (M_SQRT2 * sigma_px))));
    }
  return f;
}
Raster8 half_height(const RasterF& f) {
  Raster8 m(f.width, f.height, 1, f.pitch_m);
  for (std::size_t k = 0; k < f.data.size(); ++k) m.data[k] = f.data[k] >= 0.5f ? 255 : 0;
  return m;
}

TEST(EdgeWidth, GaussianEdgeIsTwoPointFiveSixSigma) {
  for (const double sigma : {2.0, 4.0})
    for (const double angle : {0.0, 33.0}) {
      const RasterF f = soft_vein(20, sigma, angle);
      const EdgeWidths e = edge_widths(f, centre_links(half_height(f), 0));
      EXPECT_NEAR(e.median_m * 1e3, 2 * 1.2815516 * sigma, 0.03 * 2.563 * sigma) << sigma << " at " << angle;  // a link's direction follows the stair
      EXPECT_GT(e.measured, 0.85);  // at the picture's border the skeleton of a 41 px vein forks into the corners: 2 x 10 px of 200
    }
  const RasterF sharp = soft_vein(20, 0.01);
  EXPECT_NEAR(edge_widths(sharp, centre_links(half_height(sharp), 0)).median_m * 1e3, 0.8, 0.05);  // the raster's limit
}

TEST(EdgeWidth, NeighbouringVeinIsNotAnEdge) {
  RasterF f(100, 60, 1, 0.001, 0.6f);  // between the veins the powder stays at 60 %: no 10 % level to find
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 100; ++i)
      if (j / 6 % 2 == 0) f.at(i, j) = 1.0f;
  const EdgeWidths e = edge_widths(f, {{Point(0.03, 0.027), Point(0.031, 0.027), 0.001, 0.006}});
  EXPECT_TRUE(std::isnan(e.median_m));
  EXPECT_EQ(e.measured, 0);
}

TEST(ShapeOfMetrics, AreaWidthAndLength) {
  const auto line = [](int half, int length) {
    Raster8 m(200, 100, 1, 0.001);
    for (int j = 50 - half; j <= 50 + half; ++j)
      for (int i = 20; i < 20 + length; ++i) m.at(i, j) = 255;
    return m;
  };
  const Metrics m = score_masks(line(3, 150), line(5, 150));
  EXPECT_NEAR(m.area_error, 11.0 / 7 - 1, 1e-12);
  EXPECT_NEAR(m.body_width_m * 1e3, 7, 0.1);
  EXPECT_NEAR(m.print_width_m * 1e3, 11, 0.1);
  EXPECT_NEAR(m.body_length_m * 1e3, 150, 8);  // thinning shortens each end by the half width
  EXPECT_NEAR(m.centreline_max_m, 0, 1e-9);
  EXPECT_NEAR(m.direction_coherence, 1, 0.01);  // the ends turn, and those of the wider line lie elsewhere
  EXPECT_TRUE(std::isnan(score_masks(Raster8(50, 50, 1, 0.001), Raster8(50, 50, 1, 0.001)).area_error));
}

TEST(WeightedQuantile, CountsWeights) {
  EXPECT_EQ(weighted_quantile({{3, 1}, {1, 1}, {2, 8}}, 0.5), 2);
  EXPECT_EQ(weighted_quantile({{3, 1}, {1, 1}, {2, 8}}, 0.95), 3);
  EXPECT_TRUE(std::isnan(weighted_quantile({}, 0.5)));
}
}  // namespace
}  // namespace venato::sync
