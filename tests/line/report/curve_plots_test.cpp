#include "line/report/curve_plots.h"

#include <gtest/gtest.h>
namespace venato::line {
namespace {
TEST(CurvePlots, UnitsAreTheLongestEnding) {
  EXPECT_EQ(split_unit("mass_flow_kg_s").unit, "kg/s");
  EXPECT_EQ(split_unit("mass_flow_kg_s").words, "mass flow");
  EXPECT_EQ(split_unit("diffusivity_zz_m2_s").unit, "m²/s");
  EXPECT_EQ(split_unit("latency_on_s").unit, "s");
  EXPECT_EQ(split_unit("superposition_defect").unit, "");
  EXPECT_EQ(split_unit("particles").words, "particles");
}
TEST(CurvePlots, OnePlotPerUnitAgainstTime) {
  const auto plots = plots_of_curve("c", {{"time_s", {0, 1}}, {"a_kg_s", {1, 2}}, {"b_kg_s", {3, 4}}, {"share", {0, 1}}, {"torn_kg_s", {1}}});
  ASSERT_EQ(plots.size(), 2u);
  EXPECT_EQ(plots[0].x_label, "time [s]");
  EXPECT_EQ(plots[0].series.size(), 2u) << "a column of another length is left out";
  EXPECT_EQ(plots[1].y_label, "share");
}
TEST(CurvePlots, ResidualCurveIsTheShareWithin) {
  const auto plot = residual_plot({{"after", {{0, 0, 0.001, true}, {0, 0, -0.003, true}, {0, 0, 0.1, false}}}});
  ASSERT_EQ(plot.series.size(), 1u);
  const auto& s = plot.series[0];
  const auto at = [&](double mm) { return s.y[static_cast<std::size_t>(mm / 0.05 + 0.5)]; };
  EXPECT_EQ(at(0.5), 0.0);
  EXPECT_EQ(at(1.05), 0.5);
  EXPECT_EQ(at(3.05), 1.0) << "samples without partner are not part of the matched length";
}
TEST(CurvePlots, KernelMarginalsSumToOne) {
  Operator op = identity_operator(3);
  op.n_theta = 2, op.n_eta = 1, op.dtheta_s = 0.01, op.deta_m = 0.001;
  op.weight.assign(18, 0.0);
  for (int z = 0; z < 3; ++z) op.weight[op.index(z, z, 0, 0)] = 0.25, op.weight[op.index(z, z, 1, 0)] = 0.75;
  const auto plots = plots_of_kernel(op);
  ASSERT_EQ(plots.size(), 1u) << "a single lateral cell is no curve";
  EXPECT_NEAR(plots[0].series[0].y[0], 0.25, 1e-12);
  EXPECT_NEAR(plots[0].series[0].y[1], 0.75, 1e-12);
}
}  // namespace
}  // namespace venato::line
