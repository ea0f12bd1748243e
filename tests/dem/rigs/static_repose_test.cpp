#include <gtest/gtest.h>

#include "dem/rigs/static_repose/rig.h"
#include "tests/dem/rigs/synthetic.h"

namespace venato::dem::rigs::static_repose {
namespace {
using synthetic::kpi;
constexpr double kDeg = std::numbers::pi / 180;

/// Grains uniformly inside { z < height(r, angle) }, r < R.
template <class Height>
CaseResult heap(int n, double foot_m, double grain_m, Height height, Vec3 axis = Vec3(0.003, -0.002, 0)) {
  Rng rng(3, 14);
  CaseResult r;
  while (static_cast<int>(r.final_state.size()) < n) {
    const double radius = foot_m * std::sqrt(rng.uniform()), angle = 2 * std::numbers::pi * rng.uniform(), z = 0.05 * rng.uniform();
    if (z < height(radius, angle))
      r.final_state.push_back(synthetic::grain_at(axis + Vec3(radius * std::cos(angle), radius * std::sin(angle), z), grain_m));
  }
  return r;
}
auto cone(double angle_deg, double foot_m) {
  return [=](double r, double) { return (foot_m - r) * std::tan(angle_deg * kDeg); };
}

TEST(StaticRepose, a_cone_has_its_angle) {
  constexpr double kGrain = 3e-4, kFoot = 0.02;
  const Case c = synthetic::mono_case(kGrain);
  for (const double angle : {15.0, 25.0, 35.0}) {
    const RigResult out = measure({}, c, heap(120000, kFoot, kGrain, cone(angle, kFoot)));
    // The highest grain of a cell lies as far below the surface in all rings, so the slope is not biased; measured deviation 0.15 degrees.
    EXPECT_NEAR(kpi(out.kpis, "repose_angle_deg").value, angle, 0.3) << angle;
    // Moments are exact for a cone but for 120000 random draws: 0.3 % of the tangent, 0.08 degrees; three of them.
    EXPECT_NEAR(kpi(out.kpis, "repose_angle_by_moments_deg").value, angle, 0.2) << angle;
    EXPECT_LT(kpi(out.kpis, "repose_angle_deg").standard_error, 0.3);
    EXPECT_GT(kpi(out.kpis, "repose_angle_deg").standard_error, 0);
    // Seen from above the surface lies within a grain below the cone: at 15 degrees the foot moves in by at most grain / tan(15).
    EXPECT_NEAR(kpi(out.kpis, "heap_foot_radius_mm").value, 20, 1.1);
    EXPECT_TRUE(out.warnings.empty()) << out.warnings.front();
    ASSERT_EQ(out.plots.size(), 1u);
    EXPECT_EQ(out.tables.at(0).columns.at(1).values.size(), out.plots[0].plot.series[0].y.size());
  }
}
TEST(StaticRepose, a_lopsided_heap_has_a_large_error_bar) {
  constexpr double kGrain = 2e-4, kFoot = 0.02;
  const Case c = synthetic::mono_case(kGrain);
  const auto lopsided = [&](double r, double angle) { return (kFoot - r) * std::tan((25 + 6 * std::cos(angle)) * kDeg); };
  const RigResult out = measure({}, c, heap(100000, kFoot, kGrain, lopsided));
  // The axis of such a heap is its centre of mass, which lies towards the steep side: the mean angle about it is a little above 25.
  EXPECT_NEAR(kpi(out.kpis, "repose_angle_deg").value, 26, 1.5);
  // Six wedges whose angles follow a cosine of 6 degrees: sd 4.6 (sinc of a wedge and the moved axis included), over sqrt(6) 1.7.
  EXPECT_NEAR(kpi(out.kpis, "repose_angle_deg").standard_error, 1.7, 0.9);
}
TEST(StaticRepose, what_is_no_cone_warns) {
  constexpr double kGrain = 2e-4;
  const Case c = synthetic::mono_case(kGrain);
  const auto warned = [&](const CaseResult& r, const char* text) {
    for (const std::string& w : measure({}, c, r).warnings)
      if (w.find(text) != std::string::npos) return true;
    return false;
  };
  // A dome: its flank is bent by far more than a grain.
  const auto dome = heap(60000, 0.02, kGrain, [](double r, double) { return std::sqrt(std::max(0.0, 4e-4 - r * r)) * 0.9; });
  EXPECT_TRUE(warned(dome, "this is no cone"));
  // A block with upright sides has no flank at all.
  const auto block = heap(60000, 0.02, kGrain, [](double, double) { return 0.01; });
  EXPECT_TRUE(std::isnan(kpi(measure({}, c, block).kpis, "repose_angle_deg").value));
  EXPECT_TRUE(warned(block, "fewer than three rings"));
  auto moving = heap(60000, 0.02, kGrain, cone(25, 0.02));
  EXPECT_FALSE(warned(moving, "still moves"));
  for (GrainRecord& g : moving.final_state) g.velocity_m_s = Vec3(0.01, 0, 0);
  EXPECT_TRUE(warned(moving, "still moves"));
  const auto low = heap(2000, 0.004, kGrain, cone(20, 0.004));
  EXPECT_TRUE(warned(low, "mean grains high"));
  EXPECT_TRUE(warned({}, "no angle"));
}
}  // namespace
}  // namespace venato::dem::rigs::static_repose
