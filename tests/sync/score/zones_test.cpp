#include "sync/score/zones.h"
#include <gtest/gtest.h>
#include <cmath>
#include "base/error.h"
namespace venato::sync {
namespace {
using graphics::Raster8;

/// 400 x 800 mm at 1 mm, straight veins 6 mm wide along y every 50 mm; `shift_mm(column, row)` of the zone of 200 mm that the pixel is in, 1000 =
/// none.
template <class F>
Raster8 veins(const F& shift_mm) {
  Raster8 m(400, 800, 1, 0.001);
  for (int j = 0; j < 800; ++j)
    for (int i = 0; i < 400; ++i) {
      const double shift = shift_mm(i / 200, j / 200);
      const double across = i + 0.5 - 25 - shift;
      if (shift < 900) m.at(i, j) = std::abs(across - 50 * std::round(across / 50)) <= 3 ? 255 : 0;
    }
  return m;
}
const auto kStraight = [](int, int) { return 0.0; };

TEST(Zones, EachZoneIsJudgedByItsOwnShift) {
  // Rows: 0 mm good, 2 mm fair (median above 1, P95 below 3), 6 mm bad; in the last one the left zone has no print, the right one is good.
  const auto moved = [](int i, int j) { return j == 0 ? 0.0 : j == 1 ? 2.0 : j == 2 ? 6.0 : i == 0 ? 1000.0 : 0.0; };
  const Raster8 body = veins(kStraight), print = veins(moved);
  const SlabScore s = score_zones(body, print, {}, {});
  ASSERT_EQ(s.columns, 2);
  ASSERT_EQ(s.rows, 4);
  const Verdict want[] = {Verdict::good, Verdict::good, Verdict::fair, Verdict::fair, Verdict::bad, Verdict::bad, Verdict::low_match, Verdict::good};
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(s.zones[k].verdict, want[k]) << k << " p95 " << s.zones[k].p95_m << " matched " << s.zones[k].matched;
  EXPECT_NEAR(s.zones[2].median_m, 0.002, 2e-5);
  EXPECT_NEAR(s.zones[4].median_m, 0.006, 2e-5);
  EXPECT_NEAR(s.zones[6].found, 0, 1e-12);
  EXPECT_TRUE(std::isnan(s.zones[6].median_m));
  // The whole agrees with the score of the masks.
  const Metrics m = score_masks(body, print);
  EXPECT_NEAR(s.whole.median_m, m.centreline_median_m, 1e-5);
  EXPECT_NEAR(s.whole.p95_m, m.centreline_p95_m, 1e-5);
  EXPECT_NEAR(s.whole.matched, m.matched_length, 1e-9);
  EXPECT_NEAR(s.whole.offset_m, m.centreline_offset_m, 1e-9);
}

TEST(Zones, ZonesWithoutVeinsHaveNoEvidence) {
  const auto upper = [](int, int j) { return j < 2 ? 0.0 : 1000.0; };
  const SlabScore s = score_zones(veins(upper), veins(upper), {}, {});
  EXPECT_EQ(s.zones[1].verdict, Verdict::good);
  EXPECT_EQ(s.zones[7].verdict, Verdict::no_evidence);
  EXPECT_EQ(s.whole.verdict, Verdict::good);
}

TEST(Zones, IntervalsSpreadWithTheZonesAndShrinkToNothingWithoutSpread) {
  const SlabScore same = score_zones(veins(kStraight), veins([](int, int) { return 1.0; }), {}, {});
  EXPECT_NEAR(same.median.low, same.median.high, 2e-5);
  const auto mixed = [](int i, int j) { return (i + j) % 2 ? 0.0 : 2.0; };
  const SlabScore two = score_zones(veins(kStraight), veins(mixed), {}, {});
  // Eight zones, half at 0 and half at 2 mm: with 8 draws the median lies at either end in about a third of the resamples each.
  EXPECT_LT(two.median.low, 1e-4);
  EXPECT_NEAR(two.median.high, 0.002, 5e-5);
  const SlabScore lone =
      score_zones(veins([](int i, int j) { return i + j ? 1000.0 : 0.0; }), veins([](int i, int j) { return i + j ? 1000.0 : 0.0; }), {}, {});
  EXPECT_TRUE(std::isnan(lone.p95.low));  // one zone tells nothing about others
}

/// A body vein along a border of zones, printed 2 mm beside it: the print lies in one zone, the body in the other, and both are matched.
TEST(Zones, PartnersAcrossAZonesBorderAreFound) {
  const auto line = [](double at_mm) {
    Raster8 m(400, 400, 1, 0.001);
    for (int j = 0; j < 400; ++j)
      for (int i = 0; i < 400; ++i) m.at(i, j) = std::abs(i + 0.5 - at_mm) <= 3 ? 255 : 0;
    return m;
  };
  const SlabScore s = score_zones(line(199), line(201), {}, {});
  ASSERT_EQ(s.zones.size(), 4u);
  for (const int k : {0, 2}) {  // body only: found, and no distance of its own
    EXPECT_NEAR(s.zones[static_cast<std::size_t>(k)].found, 1, 1e-9);
    EXPECT_TRUE(std::isnan(s.zones[static_cast<std::size_t>(k)].matched));
    EXPECT_EQ(s.zones[static_cast<std::size_t>(k)].verdict, Verdict::no_evidence);
  }
  for (const int k : {1, 3}) EXPECT_NE(s.zones[static_cast<std::size_t>(k)].verdict, Verdict::low_match);
  EXPECT_NEAR(s.whole.median_m, 0.002, 2e-5);
}

TEST(Zones, AnotherSeedIsAnotherDraw) {
  const auto mixed = [](int i, int j) { return 4.0 * i + j; };
  const Raster8 body = veins(kStraight), print = veins(mixed);
  ZoneConfig other;
  other.seed = 2, other.resamples = 20;
  ZoneConfig first = other;
  first.seed = 1;
  const SlabScore a = score_zones(body, print, {}, first), b = score_zones(body, print, {}, other);
  EXPECT_TRUE(a.median.low != b.median.low || a.p95.low != b.p95.low || a.p95.high != b.p95.high || a.median.high != b.median.high);
}

TEST(Zones, RefusesMasksThatDoNotFit) {
  EXPECT_THROW(score_zones(Raster8(10, 10, 1, 0.001), Raster8(10, 11, 1, 0.001), {}, {}), UsageError);
  ZoneConfig none;
  none.zone_m = 0;
  EXPECT_THROW(score_zones(Raster8(10, 10, 1, 0.001), Raster8(10, 10, 1, 0.001), {}, none), UsageError);
}
}  // namespace
}  // namespace venato::sync
