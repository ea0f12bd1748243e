#include "graphics/raster/mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/rng.h"
namespace venato::graphics {
namespace {
Raster8 blobs(int n, std::uint64_t seed) {
  Raster8 m(n, n, 1, 1e-3);
  Rng rng(seed, stream_id("tests/graphics/mask"));
  for (int b = 0; b < 12; ++b) {
    const double x = rng.uniform() * n, y = rng.uniform() * n, r = 2 + rng.uniform() * n / 8;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        if (i > 0 && j > 0 && i < n - 1 && j < n - 1 && std::hypot(i + 0.5 - x, j + 0.5 - y) < r) m.at(i, j) = 255;
  }
  return m;
}
int parts(const Raster8& m, bool of_background) {  // flood fill; 8-connected in, 4-connected out
  Raster8 seen = m;
  for (auto& v : seen.data) v = (v != 0) != of_background ? 1 : 0;
  int count = 0;
  std::vector<std::pair<int, int>> stack;
  for (int j = 0; j < m.height; ++j)
    for (int i = 0; i < m.width; ++i) {
      if (!seen.at(i, j)) continue;
      ++count;
      stack.assign(1, {i, j});
      seen.at(i, j) = 0;
      while (!stack.empty()) {
        const auto [x, y] = stack.back();
        stack.pop_back();
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int u = x + dx, v = y + dy;
            if ((of_background && dx != 0 && dy != 0) || u < 0 || v < 0 || u >= m.width || v >= m.height || !seen.at(u, v)) continue;
            seen.at(u, v) = 0;
            stack.push_back({u, v});
          }
      }
    }
  return count;
}

TEST(Mask, DistanceAgreesWithBruteForce) {
  const Raster8 m = blobs(40, 1);
  const RasterF d = distance_to(m);
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < 40; ++i) {
      double best = std::numeric_limits<double>::infinity();
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
          if (m.at(x, y)) best = std::min(best, std::hypot(x - i, y - j));
      EXPECT_NEAR(d.at(i, j), best, 1e-4);  // float square roots
    }
}
TEST(Mask, DistanceToNothingIsFar) {
  const RasterF d = distance_to(Raster8(3, 3, 1, 1e-3));
  for (float v : d.data) EXPECT_EQ(v, 1e6f);
}
TEST(Mask, SignedDistanceOfAHalfPlane) {
  Raster8 m(20, 5, 1, 1e-3);
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 8; ++i) m.at(i, j) = 1;
  const RasterF d = signed_distance(m);
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(d.at(i, 2), 8 - (i + 0.5), 1e-5);  // the edge lies at x = 8
}
TEST(Mask, ThinKeepsTopologyAndIsThin) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Raster8 m = blobs(90, seed), t = thin(m);
    EXPECT_EQ(parts(t, false), parts(m, false)) << seed;
    EXPECT_EQ(parts(t, true), parts(m, true)) << seed;
    int blocks = 0, pixels = 0;
    for (int j = 0; j + 1 < 90; ++j)
      for (int i = 0; i + 1 < 90; ++i) {
        blocks += t.at(i, j) && t.at(i + 1, j) && t.at(i, j + 1) && t.at(i + 1, j + 1);
        pixels += t.at(i, j) != 0;
        if (t.at(i, j)) {
          EXPECT_TRUE(m.at(i, j));
        }
      }
    EXPECT_LE(blocks, 2) << seed;  // Zhang-Suen may leave a 2 x 2 knot at a crossing
    EXPECT_GT(pixels, 0);
  }
}
TEST(Mask, ThinKeepsSmallBlocksAndDiagonals) {
  Raster8 m(20, 20, 1, 1e-3);
  m.at(2, 2) = m.at(3, 2) = m.at(2, 3) = m.at(3, 3) = 255;
  for (int k = 5; k < 18; ++k) m.at(k, k) = m.at(k - 1, k) = 255;
  EXPECT_EQ(parts(thin(m), false), 2);
}
TEST(Mask, ThinBarIsItsCentreLine) {
  Raster8 m(60, 21, 1, 1e-3);
  for (int j = 6; j < 15; ++j)
    for (int i = 5; i < 55; ++i) m.at(i, j) = 255;
  const Raster8 t = thin(m);
  for (int i = 15; i < 45; ++i)
    for (int j = 0; j < 21; ++j) EXPECT_EQ(t.at(i, j) != 0, j == 10) << i << "," << j;
}
TEST(Mask, SmallPartsAndHolesGo) {
  Raster8 m(30, 30, 1, 1e-3);
  for (int j = 2; j < 20; ++j)
    for (int i = 2; i < 20; ++i) m.at(i, j) = 255;
  m.at(10, 10) = m.at(11, 10) = 0;    // hole of 2
  m.at(27, 27) = m.at(26, 26) = 255;  // diagonal pair: one part of 2
  EXPECT_EQ(without_small_parts(m, 3).at(27, 27), 0);
  EXPECT_NE(without_small_parts(m, 2).at(27, 27), 0);
  EXPECT_NE(without_small_holes(m, 3).at(10, 10), 0);
  EXPECT_EQ(without_small_holes(m, 2).at(10, 10), 0);
  EXPECT_EQ(without_small_holes(m, 1e9).at(29, 0), 0);  // the outside touches the border: not a hole
}
}  // namespace
}  // namespace venato::graphics
