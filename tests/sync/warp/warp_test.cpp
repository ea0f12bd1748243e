#include "sync/warp/warp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sync/warp/bilinear.h"
#include "tests/sync/warp/warp_fixture.h"

namespace venato::sync {
namespace {

using test::bent;
using test::noise;
using test::warp_all;

constexpr WarpGrid kGrid{611, 403, 0.0254 / 360};  // odd sizes: no multiple of any chunk

Transform map_for(const WarpGrid& grid) {
  return bent(static_cast<double>(grid.width) * grid.pitch_m, static_cast<double>(grid.height) * grid.pitch_m, 0.0073, 0.0012);
}

// The positions must be right to 1/64 source px. They are a cubic between knots, evaluated exactly: 1e-6 px leaves room for rounding only.
TEST(Warp, PositionsFollowTheTransform) {
  const WarpGrid grid{24400, 48800, 0.0254 / 360};  // a whole 1.72 x 3.44 m slab
  const Transform map = bent(1.722, 3.443, 0.048, 0.010);
  const double source_pitch_m = 0.0254 / 200;
  for (const std::int64_t row : {0, 1, 679, 680, 24399, 48799}) {
    const RowPositions got = source_positions(map, source_pitch_m, grid, row);
    ASSERT_EQ(got.x.size(), static_cast<std::size_t>(grid.width));
    double worst = 0;
    for (std::int64_t i = 0; i < grid.width; ++i) {
      const Point p = map(Point((static_cast<double>(i) + 0.5) * grid.pitch_m, (static_cast<double>(row) + 0.5) * grid.pitch_m)) / source_pitch_m;
      const auto k = static_cast<std::size_t>(i);
      worst = std::max({worst, std::abs(got.x[k] - (p.x() - 0.5)), std::abs(got.y[k] - (p.y() - 0.5))});
    }
    EXPECT_LT(worst, 1e-6) << "row " << row;
  }
}

TEST(Warp, AgreesWithDoublePrecisionWithinOneLevel) {
  const Transform map = map_for(kGrid);
  for (int channels = 1; channels <= kMaxWarpChannels; ++channels) {
    const graphics::Raster8 source = noise(353, 197, channels, 0.0254 / 250);  // smaller than the slab: inside, border and outside all occur
    const auto got = warp_all(source, map, kGrid, 64, 2);
    int outside = 0, inside = 0;
    double worst = 0, sum = 0;
    for (int j = 0; j < kGrid.height; ++j)
      for (int i = 0; i < kGrid.width; ++i) {
        const Point p = map(Point((i + 0.5) * kGrid.pitch_m, (j + 0.5) * kGrid.pitch_m)) / source.pitch_m;
        const double x = p.x() - 0.5, y = p.y() - 0.5;
        // Within the kernel's 2^-14 px of the outer limit either answer is right.
        const double limit = std::min({std::abs(x + 1.5), std::abs(y + 1.5), std::abs(x - source.width - 0.5), std::abs(y - source.height - 0.5)});
        if (limit < 1e-4) continue;
        for (int c = 0; c < channels; ++c) {
          const double want = test::sample_slowly(source, x, y, c);
          const int value = got[static_cast<std::size_t>((j * kGrid.width + i) * channels + c)];
          if (want < 0) {
            EXPECT_EQ(value, 0);
            ++outside;
          } else {
            worst = std::max(worst, std::abs(value - want));
            sum += value - want;
            ++inside;
          }
        }
      }
    EXPECT_GT(outside, 1000 * channels);
    EXPECT_GT(inside, 10000 * channels);
    // Rounding to a level 0.5, positions 2 * 255 / 32768 = 0.016, the horizontal blend's 1/256: all together stay below one level.
    EXPECT_LT(worst, 0.55) << channels;
    EXPECT_NEAR(sum / inside, 0, 0.01) << "rounding must not darken or lighten";
  }
}

TEST(Warp, SameBytesForAnyStripHeightAndThreadCount) {
  const Transform map = map_for(kGrid);
  const graphics::Raster8 source = noise(353, 197, 6, 0.0254 / 250);
  const auto want = warp_all(source, map, kGrid, static_cast<int>(kGrid.height), 1);
  for (const int strip : {1, 7, 64, 400})
    for (const int threads : {1, 2, 4}) EXPECT_EQ(warp_all(source, map, kGrid, strip, threads), want) << strip << " rows, " << threads << " threads";
}

#if defined(__SSE2__)
TEST(Warp, VectorAndPlainKernelGiveTheSameBytes) {
  const graphics::Raster8 source = noise(64, 64, 6, 1);
  Rng rng(3, stream_id("test/warp/taps"));
  for (int k = 0; k < 20000; ++k) {
    const auto x = static_cast<std::ptrdiff_t>(rng.below(60)), y = static_cast<std::ptrdiff_t>(rng.below(60));
    const detail::Tap tap{source.data.data() + (y * 64 + x) * 6, 6, 64 * 6, static_cast<int>(rng.below(detail::kWeightOne + 1)),
                          static_cast<int>(rng.below(detail::kWeightOne + 1))};
    std::uint8_t plain[8] = {}, vector[8] = {};
    detail::blend_scalar<6>(tap, plain);
    detail::blend_sse2(tap, vector);
    for (int c = 0; c < 6; ++c) ASSERT_EQ(plain[c], vector[c]) << k;
  }
}
#endif

TEST(Warp, IdentityAndWholePixelShiftsMoveValuesUnchanged) {
  const graphics::Raster8 source = noise(200, 150, 5, 0.001);
  const WarpGrid grid{200, 150, 0.001};
  Transform map;
  EXPECT_EQ(warp_all(source, map, grid, 64, 2), source.data);
  map.t = Point(0.003, 0.002);
  const auto shifted = warp_all(source, map, grid, 64, 2);
  for (int j = 0; j < 148; ++j)
    for (int i = 0; i < 197; ++i)
      for (int c = 0; c < 5; ++c) ASSERT_EQ(shifted[static_cast<std::size_t>((j * 200 + i) * 5 + c)], source.at(i + 3, j + 2, c));
}

TEST(Warp, ConstantsStayConstantUnderAnyWarp) {
  const Transform map = map_for(kGrid);
  for (const int value : {1, 127, 254, 255}) {
    const auto level = static_cast<std::uint8_t>(value);
    const graphics::Raster8 source(400, 400, 3, 0.0002, level);
    const auto got = warp_all(source, map, {200, 150, 0.0001}, 64, 1);
    int inside = 0;
    for (const auto v : got) {
      EXPECT_TRUE(v == level || v == 0);
      inside += v == level;
    }
    EXPECT_GT(inside, 1000);
  }
}

TEST(Warp, BorderIsContinuedByOnePixelAndThenThereIsNoInk) {
  const graphics::Raster8 source(4, 1, 1, 0.001, 200);  // one pixel high: no second row to blend with
  Transform map;
  map.t = Point(-0.004, -0.003);
  const auto got = warp_all(source, map, {12, 7, 0.001}, 64, 1);
  for (int j = 0; j < 7; ++j)
    for (int i = 0; i < 12; ++i) {
      const bool covered = i >= 3 && i <= 8 && j >= 2 && j <= 4;  // graphic at columns 4..7, row 3, plus one pixel around
      EXPECT_EQ(got[static_cast<std::size_t>(j * 12 + i)], covered ? 200 : 0) << i << "," << j;
    }
}

TEST(Warp, SinglePixelAndFarAwayAndNanAreSafe) {
  const graphics::Raster8 source(1, 1, 2, 0.001, 9);
  Transform map;
  map.t = Point(1e12, -1e12);
  EXPECT_EQ(warp_all(source, map, {3, 3, 0.001}, 8, 1), std::vector<std::uint8_t>(18, 0));
  map.t = Point(std::nan(""), 0);
  EXPECT_EQ(warp_all(source, map, {3, 3, 0.001}, 8, 1), std::vector<std::uint8_t>(18, 0));
}

TEST(Warp, ReductionAveragesWholeBoxes) {
  const graphics::Raster8 source = noise(101, 67, 2, 0.0001);
  EXPECT_TRUE(reduced_if_finer(source, 0.00019).empty());
  const graphics::Raster8 third = reduced_if_finer(source, 0.0003);
  ASSERT_EQ(third.width, 34);
  ASSERT_EQ(third.height, 23);
  EXPECT_NEAR(third.pitch_m, 0.0003, 1e-15);
  for (int j = 0; j < third.height; ++j)
    for (int i = 0; i < third.width; ++i) {
      double sum = 0;
      int n = 0;
      for (int y = 3 * j; y < std::min(67, 3 * j + 3); ++y)
        for (int x = 3 * i; x < std::min(101, 3 * i + 3); ++x, ++n) sum += source.at(x, y, 1);
      ASSERT_NEAR(third.at(i, j, 1), sum / n, 0.5001);  // one rounding
    }
}

}  // namespace
}  // namespace venato::sync
