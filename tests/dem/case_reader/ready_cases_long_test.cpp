// The ready cases in full, against what is known of such experiments.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <numbers>

#include "base/store/store.h"
#include "base/units.h"
#include "dem/case_outputs/case_outputs.h"
#include "dem/case_reader.h"

namespace venato::dem {
namespace {
struct Run {
  Case c;
  CaseResult result;
};
Run run(const char* file) {
  const auto log = make_null_log();
  const auto progress = make_null_progress();
  const auto folder = std::filesystem::temp_directory_path() / ("venato_ready_cases_long_" + std::to_string(::getpid()));
  Store store(folder);
  Run r;
  r.c = load_case(std::filesystem::path(VENATO_SOURCE_DIR) / "configs/dem" / file);
  Context context{*log, *progress, store, r.c.seed, 1, nullptr};
  r.result = run_case(r.c, {}, context);
  std::filesystem::remove_all(folder);
  return r;
}

TEST(ReadyCases, the_slot_discharges_as_beverloo_says) {
  const auto [c, result] = run("slot_hopper.json");
  EXPECT_NEAR(result.mass_removed_kg / result.mass_put_in_kg, 1, 1e-12);  // it runs empty
  const FlowEstimate flow = steady_flow(result.records.at(0));
  double volume_mean = 0;
  for (const CounterRecord& r : result.records[0]) volume_mean += r.mass_kg * r.diameter_m / result.mass_removed_kg;
  // Slot law W = 1.03 rho_b sqrt(g) L (B - k d)^1.5 with k = 1.4 (multiscale.md 4), slot 8 mm (periodic: no k d taken off) x 6 mm. Bulk density 0.58
  // of the grain's; constant and k are known to about 20 % between powders and wall angles, and a slot of 6 grains is at the lower end of the law.
  const double law = 1.03 * 0.58 * 1900 * std::sqrt(kStandardGravity_m_s2) * 8e-3 * std::pow(6e-3 - 1.4 * volume_mean, 1.5);
  EXPECT_NEAR(flow.mean_kg_s / law, 1, 0.25) << flow.mean_kg_s << " " << law;
  EXPECT_LT(flow.standard_error_kg_s / flow.mean_kg_s, 0.05);
  RecordProperty("flow_over_law", std::to_string(flow.mean_kg_s / law));
}

TEST(ReadyCases, the_lifted_cylinder_leaves_a_heap_at_rest) {
  const auto [c, result] = run("lifted_cylinder.json");
  EXPECT_EQ(result.mass_lost_box_kg, 0);
  double mass = 0, height = 0, radius = 0;
  for (const GrainRecord& g : result.final_state) {
    const double m = std::pow(g.diameter_m, 3);
    mass += m;
    height += m * g.position_m.z();
    radius += m * std::hypot(g.position_m.x(), g.position_m.y());
  }
  // A cone has mean height H/4 and mean distance from its axis R/2: tan(slope) = H/R = 2 <z> / <r>. The band is what free-flowing powders do.
  const double slope = std::atan(2 * height / radius) * 180 / std::numbers::pi;
  EXPECT_GT(slope, 12) << slope;
  EXPECT_LT(slope, 40) << slope;
  RecordProperty("slope_deg", std::to_string(slope));
  // At rest: kinetic energy below what lifting all grains by a micrometre takes.
  EXPECT_LT(result.series.kinetic_energy_j.back(), result.mass_left_kg * kStandardGravity_m_s2 * 1e-6);
}
}  // namespace
}  // namespace venato::dem
