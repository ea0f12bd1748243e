#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/store/store.h"
#include "base/units.h"
#include "dem/rigs/inclined_wall/rig.h"
#include "tests/base/temp_folder.h"
#include "tests/dem/rigs/synthetic.h"

namespace venato::dem::rigs::inclined_wall {
namespace {
using synthetic::kpi;
constexpr double kDeg = std::numbers::pi / 180, kGrain = 2e-3;

/// A plate through the origin that turns about x at `deg_s`.
Case tilting(double deg_s) {
  Case c = synthetic::mono_case(kGrain);
  c.materials = {{{"grain", 2000, 1e6, 0.25}, {"plate", 2000, 1e8, 0.25}}, std::vector<PairProperties>(4, PairProperties{0.3, 0.5, 0.1, 0.3})};
  c.walls.resize(1);
  c.walls[0].name = "plate";
  c.walls[0].shape = PlaneShape{Vec3::Zero(), Vec3::UnitZ()};
  c.walls[0].material = 1;
  c.walls[0].motion.rotation_rad_s = Vec3(deg_s * kDeg, 0, 0);
  return c;
}
Config watch(double moved_m = 0) {
  Config w;
  w.moved_m = moved_m;
  return w;
}

/// 600 grains that ride on the plate and jump `jump_m` down it at angles spread evenly from 20 to 30 degrees; ids with gaps.
CaseResult made_up(const Case& c, double jump_m, bool leave_the_case = false) {
  CaseResult r;
  r.snapshots.resize(1);
  constexpr int kN = 600;
  for (int f = 0; f <= 200; ++f) {
    Snapshot s;
    s.time_s = 0.02 * f;
    const double tilt = c.walls[0].motion.rotation_rad_s.x() * s.time_s;
    for (int k = 0; k < kN; ++k) {
      const double share = (k * 37 % kN + 0.5) / kN;  // unrelated to the place
      const bool off = tilt / kDeg >= 20 + 10 * share;
      if (off && leave_the_case) continue;
      const Vec3 drawn(0.001 * (k % 30), 0.001 * (k / 30) - (off ? jump_m : 0), 0.001);
      s.id.push_back(3 * k);
      s.position_m.push_back(Eigen::AngleAxisd(tilt, Vec3::UnitX()) * drawn);
      s.radius_m.push_back(1e-3f);
      s.species.push_back(0);
    }
    r.snapshots[0].push_back(s);
  }
  return r;
}
TEST(InclinedWall, known_slide_angles_come_back) {
  const Case c = tilting(10);
  for (const bool leave : {false, true}) {
    const RigResult out = measure(watch(), c, made_up(c, 1.1 * kGrain, leave));
    // Frames every 0.2 degrees.
    EXPECT_NEAR(kpi(out.kpis, "first_slide_angle_deg").value, 21, 0.2);
    EXPECT_NEAR(kpi(out.kpis, "slide_angle_deg").value, 25, 0.2);
    EXPECT_NEAR(kpi(out.kpis, "last_slide_angle_deg").value, 29, 0.2);
    // 100 grains a strip with angles spread over 10 degrees: their medians scatter by at most 10 x 0.5 / sqrt(100), over sqrt(6) strips.
    EXPECT_LT(kpi(out.kpis, "slide_angle_deg").standard_error, 0.3);
    EXPECT_TRUE(out.warnings.empty()) << out.warnings.front();
  }
}
TEST(InclinedWall, riding_along_is_not_sliding) {
  const Case c = tilting(10);
  const RigResult out = measure(watch(), c, made_up(c, 0.9 * kGrain));  // less than the grain that counts
  EXPECT_TRUE(std::isnan(kpi(out.kpis, "slide_angle_deg").value));
  ASSERT_EQ(out.warnings.size(), 1u);
  EXPECT_NE(out.warnings[0].find("tilt farther"), std::string::npos);
  EXPECT_NEAR(tilt_deg(c, watch(), 2.5), 25, 1e-9);
  EXPECT_NEAR(angle_at({10, 20, 30}, {0, 0.4, 0.8}, 0.5), 22.5, 1e-12);
  EXPECT_TRUE(std::isnan(angle_at({10, 20}, {0, 0.4}, 0.5)));
}

/// The engine behind the rig: single grains far from each other.
double single_grain_angle(double sliding, double rolling, double deg_s, double moved_m) {
  TempFolder t;
  const auto log = make_null_log();
  const auto progress = make_null_progress();
  Store store(t / "store");
  Context context{*log, *progress, store, 0, 1, nullptr};
  Case c = tilting(deg_s);
  for (PairProperties& p : c.materials.pairs) p.sliding_friction = sliding, p.rolling_friction = rolling;
  c.duration_s = 25 / deg_s;
  for (int k = 0; k < 12; ++k) {
    GrainRecord g;
    g.position_m = Vec3(0.01 * (k % 4), 0.01 * (k / 4), 0.5 * kGrain);
    g.diameter_m = kGrain;
    c.handed_over.push_back(g);
  }
  Config config = watch(moved_m);
  config.from_s = 0.2, config.to_s = c.duration_s;
  c.snapshots = {{config.from_s, config.to_s, 0.005}};
  return kpi(measure(config, c, run_case(c, {}, context)).kpis, "slide_angle_deg").value;
}
TEST(InclinedWall, single_grains_roll_at_the_rolling_and_slide_at_the_sliding_friction) {
  constexpr double kRate = 20 * kDeg, kMoved = 1e-4;
  // From the limit angle on the grain is driven by inertia * g * (angle - limit) cos: moved = inertia g cos rate t^3 / 6. Inertia 5/7 rolling, 1
  // sliding.
  const auto expected = [&](double friction, double inertia) {
    const double limit = std::atan(friction), t = std::cbrt(6 * kMoved / (inertia * kStandardGravity_m_s2 * std::cos(limit) * kRate));
    return (limit + kRate * t) / kDeg;
  };
  // Frames every 0.1 degree; the elastic part of the rolling and sliding springs and the small-angle drive leave a little more.
  EXPECT_NEAR(single_grain_angle(0.5, 0.15, 20, kMoved), expected(0.15, 5.0 / 7), 0.25);
  EXPECT_NEAR(single_grain_angle(0.25, 0.6, 20, kMoved), expected(0.25, 1), 0.25);
}
}  // namespace
}  // namespace venato::dem::rigs::inclined_wall
