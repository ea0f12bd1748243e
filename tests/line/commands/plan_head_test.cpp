#include "line/commands/plan_head.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/error.h"
namespace venato::line {
namespace {

/// Strip of 40 x 100 mm, design 20 x 60 mm at trim 10 mm and lead 20 mm, no shrinkage: belt and design lengths agree.
LineBasics basics() {
  LineBasics b;
  b.fired_width_m = 0.02, b.fired_length_m = 0.06, b.belt_speed_m_s = 0.1;
  b.powders.resize(2);
  b.powders[0].name = "white", b.powders[1].name = "grey";
  b.grid.nx = 40, b.grid.ny = 100, b.grid.nz = 2, b.grid.pitch_m = 0.001, b.grid.lead_m = 0.02;
  b.trim_m = 0.01;
  return b;
}
/// Vein fraction v(i, j) on a 1 mm raster of the design.
template <class F>
graphics::VeinPlan plan_of(F&& v) {
  graphics::VeinPlan p;
  p.powders = {"white", "grey"};
  p.fraction = graphics::RasterF(20, 60, 2, 0.001);
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 20; ++i) {
      p.fraction.at(i, j, 1) = static_cast<float>(v(i, j));
      p.fraction.at(i, j, 0) = 1 - p.fraction.at(i, j, 1);
    }
  return p;
}
const HeadLayout kLayout{"vein_grey", "grey", 8, 50, 0.005, 0.02, 25.0};
double at(const std::vector<double>& v, int tick, int prong) { return v[static_cast<std::size_t>(tick * 8 + prong)]; }

TEST(PlanHead, CellAveragesAreExact) {
  // A vein over design x in [3, 8) mm, y in [10, 15) mm = belt x [13, 18), y [30, 35). Prong 2 covers [10, 15): 2/5 of it; prong 3 covers [15, 20):
  // 3/5. Tick 15 covers y [30, 32).
  const auto f = cell_fractions(plan_of([](int i, int j) { return i >= 3 && i < 8 && j >= 10 && j < 15 ? 1.0 : 0.0; }), 1, basics(), kLayout);
  EXPECT_NEAR(at(f, 15, 2), 0.4, 1e-9);
  EXPECT_NEAR(at(f, 15, 3), 0.6, 1e-9);
  EXPECT_NEAR(at(f, 17, 2), 0.2, 1e-9);  // tick 17 covers [34, 36): half of it is vein
  EXPECT_EQ(at(f, 14, 2), 0.0);
  const double mass = std::accumulate(f.begin(), f.end(), 0.0) * 0.005 * 0.002;
  EXPECT_NEAR(mass, 25e-6, 1e-12);  // area of the vein
}

TEST(PlanHead, BleedsIntoTheTrimAndNoFurther) {
  const auto f = cell_fractions(plan_of([](int, int) { return 1.0; }), 1, basics(), kLayout);
  for (int p = 0; p < 8; ++p) {
    EXPECT_NEAR(at(f, 25, p), 1.0, 1e-9);  // across: to the edge of the strip
    EXPECT_NEAR(at(f, 5, p), 1.0, 1e-9);   // along: 10 mm before the design, y [10, 12)
    EXPECT_NEAR(at(f, 4, p), 0.0, 1e-12);  // y [8, 10) is lead-in
    EXPECT_NEAR(at(f, 44, p), 1.0, 1e-9);
    EXPECT_NEAR(at(f, 45, p), 0.0, 1e-12);
  }
  const auto body = cell_fractions(plan_of([](int, int) { return 1.0; }), 0, basics(), kLayout);
  EXPECT_EQ(at(body, 4, 0), 1.0);
}

TEST(PlanHead, OnOffThreshold) {
  CommandRules rules;
  const auto head = plan_head(plan_of([](int i, int) { return i < 5 ? 0.51 : 0.49; }), 1, basics(), kLayout, rules);
  EXPECT_EQ(at(head.duty, 25, 2), 1.0);
  EXPECT_EQ(at(head.duty, 25, 3), 0.0);
  EXPECT_NEAR(head.mass_kg(), std::accumulate(head.duty.begin(), head.duty.end(), 0.0) * 25 * 0.005 * 0.002, 1e-12);
}

TEST(PlanHead, ComplementFillsEveryCell) {
  const auto vein =
      plan_head(plan_of([](int i, int j) { return (i + j) % 7 < 3 ? 0.8 : 0.1; }), 1, basics(), kLayout, {DutyMode::proportional, 0.5, 0, 0});
  const auto body = complement_head({vein}, "body_white", "white", 26.0);
  for (std::size_t c = 0; c < vein.duty.size(); ++c) EXPECT_NEAR(vein.duty[c] * 25 + body.duty[c] * 26, 26, 1e-9);
  EXPECT_NEAR(vein.mass_kg() + body.mass_kg(), 26 * 0.04 * 0.1, 1e-9);
  EXPECT_THROW(complement_head({vein}, "body", "white", 10.0), UsageError);
}

TEST(PlanHead, LayoutMustFit) {
  EXPECT_THROW(strip_layout(basics(), "h", "grey", 0.007, 0.02, 25), UsageError);
  EXPECT_THROW(strip_layout(basics(), "h", "grey", 0.005, 0.03, 25), UsageError);
  const double tick = fit_tick(basics(), 0.03);
  EXPECT_LE(tick, 0.03);
  EXPECT_EQ(strip_layout(basics(), "h", "grey", 0.005, tick, 25).ticks, 34);
}

std::string text(const std::vector<double>& v) {
  std::string s;
  for (double x : v) s += x > 0 ? '#' : '.';
  return s;
}
std::vector<double> column(const std::string& s) {
  std::vector<double> v;
  for (char c : s) v.push_back(c == '#');
  return v;
}
std::string enforced(const std::string& s, int on, int off) {
  auto v = column(s);
  enforce_min_times(v, on, off);
  return text(v);
}

TEST(MinTimes, GapsCloseBeforePulsesGrow) {
  EXPECT_EQ(enforced("....##.##....", 1, 2), "....#####....");
  EXPECT_EQ(enforced(".....#.......", 3, 1), "....###......");
  EXPECT_EQ(enforced("....##.......", 3, 1), "....###......");
  EXPECT_EQ(enforced("....###......", 3, 3), "....###......");
}
TEST(MinTimes, StripIsEndless) {
  EXPECT_EQ(enforced("#...........#", 1, 1), "#...........#");
  EXPECT_EQ(enforced("#............", 3, 1), "##..........#");
  EXPECT_EQ(enforced(".##########.", 1, 3), "############");
}
TEST(MinTimes, ConstantColumnsStay) {
  EXPECT_EQ(enforced("......", 3, 3), "......");
  EXPECT_EQ(enforced("######", 3, 3), "######");
}
}  // namespace
}  // namespace venato::line
