#include "line/chain/exact_map.h"

#include <gtest/gtest.h>

#include "base/store/store.h"
#include "line/chain/sync_step.h"
#include "tests/base/temp_folder.h"
#include "tests/line/support/fake_line.h"
namespace venato::line {
namespace {

LineConfig config_with(const std::vector<Override>& overrides = {}) {
  static const auto stages = fake::stages();
  return load_line_config_text(fake::config_text(), "/", overrides, stages);
}
/// Slab that lies on the strip exactly as planned.
Slab planned_slab(const LineConfig& c) {
  const auto& b = c.basics;
  Slab slab;
  const double pitch = 0.001, s = 1 / (1 + b.nominal_springback);
  slab.belt_from_green_m = graphics::RasterF(108, 215, 2, pitch);
  for (int j = 0; j < 215; ++j)
    for (int i = 0; i < 108; ++i) {
      slab.belt_from_green_m.at(i, j, 0) = static_cast<float>((i + 0.5) * pitch * s + b.trim_m);
      slab.belt_from_green_m.at(i, j, 1) = static_cast<float>((j + 0.5) * pitch * s + b.grid.lead_m);
    }
  return slab;
}

TEST(ExactMap, PlannedSlabNeedsOnlyTheDryingScale) {
  const auto c = config_with();
  const auto slab = planned_slab(c);
  const auto map = make_exact_map(c, slab, JitterField{}, {0, 0}, 1.0);
  const sync::Point p(0.05, 0.12);
  // Positions on the belt are floats: 0.03 um at 0.3 m.
  EXPECT_LT((map(p) - p * 0.999).norm(), 1e-7);
}

TEST(ExactMap, UndoesShiftAndJitterAndPlacement) {
  const auto c = config_with({{"/graphic/placement", R"({"dx_mm":3,"dy_mm":-2})"}});
  const auto slab = planned_slab(c);
  const JitterField jitter({0.002, 0.4}, c.basics.grid.ny * c.basics.grid.pitch_m, 7);
  const auto map = make_exact_map(c, slab, jitter, {0.001, 0.004}, 1.0);
  const sync::Point p(0.05, 0.12);
  const double to_print = c.basics.print_from_design() / c.basics.belt_from_design();
  const double y_belt = 0.12 / 1.005 + c.basics.grid.lead_m;
  const sync::Point expected(0.05 / 1.005 * to_print + 0.003, (jitter.undo(y_belt) - 0.004 - c.basics.grid.lead_m) * to_print - 0.002);
  EXPECT_LT((map(p) - expected).norm(), 1e-7);
}

TEST(ExactMap, ProbeReadsTheChainsOwnDisplacement) {
  // The fake line lays powder where the heads say, so every layer's centroid stays put; the probe must say so to rounding, on a coarse grid too.
  const auto c = config_with();
  TempFolder folder;
  Store store(folder.path());
  const auto log = make_null_log();
  const auto progress = make_null_progress();
  Context context{*log, *progress, store, 7, 1, nullptr};
  std::vector<Operator> operators;
  for (const auto& s : c.chain) operators.push_back(obtain_operator(c, s, context).op);
  graphics::VeinPlan plan;
  plan.powders = {"white", "grey"};
  plan.fraction = graphics::RasterF(10, 20, 2, 0.01, 0.0f);
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 10; ++i) plan.fraction.at(i, j, 0) = 1;
  const auto commands = c.chain[0].stage.plan_commands(plan, c.basics);
  const auto shifts = layer_shifts(c, coarse_basics(c, 0.005), operators, commands, context);
  ASSERT_EQ(shifts.size(), 10u);
  for (double s : shifts) EXPECT_NEAR(s, 0, 1e-12);  // rounding
}

TEST(SyncStep, DriedTransformIsTheSameMapOnASmallerSlab) {
  sync::Transform t;
  t.a << 1.01, 0.02, -0.01, 0.99;
  t.t = {0.003, -0.004};
  t.u = sync::make_zero_field(0.6, 1.2, 0.1);
  for (std::size_t k = 0; k < t.u.cx.size(); ++k) t.u.cx[k] = 1e-3 * std::sin(double(k)), t.u.cy[k] = 1e-3 * std::cos(double(k));
  const auto dried = on_dried_slab(t, 0.999);
  for (const auto& p : {sync::Point(0.1, 0.2), sync::Point(0.45, 1.0)}) EXPECT_LT((dried(p * 0.999) - t(p)).norm(), 1e-12);
}

TEST(SampleBilinear, IsLinearBetweenPixelCentres) {
  graphics::RasterF r(2, 2, 1, 0.5);
  r.data = {0, 1, 2, 3};
  EXPECT_DOUBLE_EQ(sample_bilinear(r, 0.5, 0.5, 0), 1.5);
  EXPECT_DOUBLE_EQ(sample_bilinear(r, 0.25, 0.25, 0), 0.0);
  EXPECT_DOUBLE_EQ(sample_bilinear(r, -1, 9, 0), 2.0);
}
}  // namespace
}  // namespace venato::line
