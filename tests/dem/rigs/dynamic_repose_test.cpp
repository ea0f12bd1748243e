#include <gtest/gtest.h>

#include <functional>

#include "dem/rigs/dynamic_repose/rig.h"
#include "tests/dem/rigs/synthetic.h"

namespace venato::dem::rigs::dynamic_repose {
namespace {
using synthetic::kpi;
constexpr double kGrain = 1e-3, kRadius = 0.02, kDeg = std::numbers::pi / 180, kLength = 0.01;

/// Grains at random (solid fraction 0.55) in the drum below z = surface(y); drum along x, centre (0.1, 0.2).
Snapshot drum(double time_s, std::uint64_t seed, const std::function<double(double)>& surface) {
  Rng rng(seed, 77);
  Snapshot s;
  s.time_s = time_s;
  const double volume = std::numbers::pi / 6 * std::pow(kGrain, 3);
  const auto n = static_cast<int>(0.55 * 4 * kRadius * kRadius * kLength / volume);
  for (int k = 0; k < n; ++k) {
    const double y = kRadius * (2 * rng.uniform() - 1), z = kRadius * (2 * rng.uniform() - 1), x = kLength * rng.uniform();
    if (y * y + z * z > kRadius * kRadius || z > surface(y)) continue;
    s.id.push_back(k);
    s.position_m.emplace_back(x, 0.1 + y, 0.2 + z);
    s.velocity_m_s.emplace_back(Vec3::Zero());
    s.radius_m.push_back(static_cast<float>(0.5 * kGrain));
    s.species.push_back(0);
  }
  return s;
}
Config one_speed() {
  Config c;
  c.centre_m[0] = 0.1, c.centre_m[1] = 0.2;
  c.radius_m = kRadius;
  c.plateaus = {{10 * std::numbers::pi / 30, 0, 1, 0}};
  return c;
}
CaseResult frames(int n, const std::function<double(int, double)>& surface) {
  CaseResult r;
  r.snapshots.resize(1);
  for (int f = 0; f < n; ++f) r.snapshots[0].push_back(drum(0.01 * f, 100 + static_cast<std::uint64_t>(f), [&](double y) { return surface(f, y); }));
  return r;
}

TEST(DynamicRepose, a_tilted_plane_has_its_angle) {
  const Case c = synthetic::mono_case(kGrain);
  for (const double angle : {-30.0, 20.0, 30.0, 40.0}) {
    const auto r = frames(40, [&](int, double y) { return -0.002 + std::tan(angle * kDeg) * y; });
    const RigResult out = measure(one_speed(), c, r);
    const Kpi& k = kpi(out.kpis, "dynamic_angle_at_10_rpm_deg");
    // Columns of 1 mm: the staircase of the cells leaves up to a few tenths of a degree, more on steep slopes (measured < 0.6).
    EXPECT_NEAR(k.value, std::abs(angle), 0.8) << angle;
    EXPECT_GT(k.standard_error, 0);
    EXPECT_LT(k.standard_error, 0.5);
    EXPECT_TRUE(out.warnings.empty()) << out.warnings.front();
    EXPECT_EQ(out.plots.size(), 2u);
  }
}
TEST(DynamicRepose, which_way_it_rises_and_where_it_lies) {
  const Config config = one_speed();
  const Snapshot s = drum(0, 3, [](double y) { return -0.002 + std::tan(25 * kDeg) * y; });
  const Surface up = free_surface({&s}, config, kGrain);
  EXPECT_GT(surface_angle_deg(up, config), 15);  // one frame: noisy
  const Snapshot t = drum(0, 3, [](double y) { return -0.002 - std::tan(25 * kDeg) * y; });
  EXPECT_LT(surface_angle_deg(free_surface({&t}, config, kGrain), config), -15);
  std::vector<Snapshot> many;
  for (std::uint64_t k = 0; k < 60; ++k) many.push_back(drum(0, k, [](double) { return 0.004; }));
  std::vector<const Snapshot*> pointers;
  for (const Snapshot& one : many) pointers.push_back(&one);
  const Surface flat = free_surface(pointers, config, kGrain);
  double sum = 0, n = 0;
  for (std::size_t k = 0; k < flat.across_m.size(); ++k)
    if (std::abs(flat.across_m[k]) < 0.01) sum += flat.height_m[k], n += 1;
  EXPECT_NEAR(sum / n, 0.004, 0.5e-3);  // half a cell
  EXPECT_NEAR(surface_angle_deg(flat, config), 0, 0.5);
}
TEST(DynamicRepose, drift_empty_drums_and_small_drums_are_told) {
  const Case c = synthetic::mono_case(kGrain);
  const auto warned = [](const RigResult& out, const char* text) {
    for (const std::string& w : out.warnings)
      if (w.find(text) != std::string::npos) return true;
    return false;
  };
  const auto starting = frames(40, [&](int f, double y) { return -0.002 + std::tan((10 + 0.6 * f) * kDeg) * y; });
  EXPECT_TRUE(warned(measure(one_speed(), c, starting), "drifts by"));
  const auto empty = frames(40, [](int, double) { return -1.0; });
  const RigResult out = measure(one_speed(), c, empty);
  EXPECT_TRUE(std::isnan(kpi(out.kpis, "dynamic_angle_at_10_rpm_deg").value));
  EXPECT_TRUE(warned(out, "no free surface"));
  EXPECT_TRUE(std::isnan(kpi(measure(one_speed(), c, frames(5, [](int, double) { return 0.0; })).kpis, "dynamic_angle_at_10_rpm_deg").value));
  EXPECT_TRUE(warned(measure(one_speed(), synthetic::mono_case(2e-3), empty), "only 10 mean grains"));
}
TEST(DynamicRepose, fluctuations_grow_with_the_waves_of_the_surface) {
  const Case c = synthetic::mono_case(kGrain);
  const auto plane = [](double y) { return std::tan(25 * kDeg) * y; };
  const auto calm = measure(one_speed(), c, frames(40, [&](int, double y) { return plane(y); }));
  const auto waves = measure(one_speed(), c, frames(40, [&](int f, double y) { return plane(y) + (f % 2 ? 2e-3 : -2e-3); }));
  const double a = kpi(calm.kpis, "surface_fluctuation_at_10_rpm_mm").value, b = kpi(waves.kpis, "surface_fluctuation_at_10_rpm_mm").value;
  EXPECT_LT(a, 1.0);                   // sampling noise of about one grain per cell column
  EXPECT_NEAR(b * b - a * a, 4, 1.5);  // variances add: 2 mm up and down
}
}  // namespace
}  // namespace venato::dem::rigs::dynamic_repose
