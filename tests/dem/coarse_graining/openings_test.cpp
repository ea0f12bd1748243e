#include "dem/coarse_graining/openings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/units.h"

namespace venato::dem {
namespace {
/// Flow through a hole by Beverloo with rho_b 1100, C .58, k 1.4 [g/s].
double hole_flow(double diameter_m, double grain_m) {
  return 1e3 * 0.58 * 1100 * std::sqrt(kStandardGravity_m_s2) * std::pow(diameter_m - 1.4 * grain_m, 2.5);
}

TEST(CoarseFlowFactor, is_the_ratio_of_the_tabulated_flows) {
  // d = 0.35 mm; flows in g/s for cg 1, 2, 4, computed by hand from Beverloo's law to four digits.
  const struct {
    double mm, g1, g2, g4;
  } rows[] = {{4, 1.459, 1.002, .376}, {6, 4.503, 3.568, 2.073}, {8, 9.767, 8.251, 5.666}, {10, 17.62, 15.44, 11.58}};
  for (const auto& row : rows) {
    EXPECT_NEAR(hole_flow(row.mm * 1e-3, 0.35e-3) / row.g1, 1, 1e-3);  // the table's digits
    EXPECT_NEAR(coarse_flow_factor(row.mm * 1e-3, 0.35e-3, 2, false), row.g2 / row.g1, 1.5e-3);
    EXPECT_NEAR(coarse_flow_factor(row.mm * 1e-3, 0.35e-3, 4, false), row.g4 / row.g1, 1.5e-3);
  }
  EXPECT_EQ(coarse_flow_factor(5e-3, 0.35e-3, 1, true), 1);
  EXPECT_NEAR(coarse_flow_factor(5e-3, 0.4e-3, 2, true), std::pow((5 - 1.12) / (5 - 0.56), 1.5), 1e-12);
  EXPECT_EQ(coarse_flow_factor(5e-3, 0.4e-3, 9, true), 0);                // 1.4 x 3.6 mm > 5 mm
  EXPECT_TRUE(std::isnan(coarse_flow_factor(0.5e-3, 0.4e-3, 2, false)));  // not even the real grains
}
TEST(CoarseFlowFactor, the_advised_coarse_graining_gives_the_asked_factor) {
  for (const bool slot : {false, true})
    for (const double opening : {3e-3, 8e-3, 20e-3}) {
      const double cg = coarse_graining_for(0.9, opening, 0.4e-3, slot);
      EXPECT_GT(cg, 1);
      EXPECT_NEAR(coarse_flow_factor(opening, 0.4e-3, cg, slot), 0.9, 1e-12);
    }
}
TEST(OpeningWarning, speaks_below_six_grains_or_beyond_ten_percent) {
  const double d = 0.4e-3;
  EXPECT_EQ(opening_warning("hole", 42e-3, false, d, 4), "");        // 26 grains: 0.902
  EXPECT_NE(opening_warning("hole", 40e-3, false, d, 4), "");        // 25 grains: 0.897
  EXPECT_EQ(opening_warning("gap", 2.4e-3 * 1.01, true, d, 1), "");  // real grains, 6 of them
  const std::string few = opening_warning("prong gap", 5e-3, true, d, 4);
  // 5 / 1.6 = 3.1 grains; ((5 - 2.24) / (5 - 0.56))^1.5 = 0.490; six grains: cg 5 / 2.4 = 2.08; 0.9: (5 - 0.9322 x 4.44) / 0.56 = 1.538
  for (const char* part : {"prong gap of 5 mm", "3.1 coarse grains", "1.6 mm each", "fewer than the 6", "0.49 of the flow", "<= 2.08", "<= 1.54"})
    EXPECT_NE(few.find(part), std::string::npos) << part << " in: " << few;
  const std::string lossy = opening_warning("hole", 10e-3, false, d, 3);  // 8.3 grains, ((10-1.68)/(10-.56))^2.5 = 0.729
  EXPECT_NE(lossy.find("0.73 of the flow"), std::string::npos) << lossy;
  EXPECT_EQ(lossy.find("fewer than"), std::string::npos) << lossy;
  EXPECT_NE(opening_warning("hole", 0.5e-3, false, d, 2).find("not even the real grains"), std::string::npos);
  EXPECT_NE(opening_warning("hole", 2e-3, false, d, 1).find("even the real grains"), std::string::npos);
}
TEST(LayerWarning, speaks_below_ten_grains) {
  EXPECT_EQ(layer_warning(8e-3, 0.4e-3, 2), "");
  EXPECT_EQ(layer_warning(0, 0.4e-3, 20), "");  // not stated
  const std::string text = layer_warning(8e-3, 0.4e-3, 4);
  for (const char* part : {"8 mm", "5.0 coarse grains", "1.6 mm", "<= 2"}) EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}
TEST(CoarseGrainingWarnings, of_a_case_use_its_largest_powder) {
  Case c;
  c.powders = {{"fine", {2e-4, 3, 2e-4, 2e-4}, 0}, {"coarse", {4e-4, 3, 4e-4, 4e-4}, 0}};
  c.coarse_graining = 4;
  EXPECT_NEAR(mean_volume_grain_m(c), 1.6e-3, 1e-12);
  EXPECT_TRUE(coarse_graining_warnings(c).empty());
  c.openings = {{"gate", 5e-3, true}, {"hatch", 0.1, true}};
  c.layer_thickness_m = 10e-3;
  const auto warnings = coarse_graining_warnings(c);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("gate of 5 mm is 3.1 coarse grains"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("layer of 10 mm is 6.2 coarse grains"), std::string::npos) << warnings[1];
  // A Weibull powder: the mean volume is that of its number law, between its cuts.
  const double d = mean_volume_grain_m({4e-4, 3, 3e-4, 6e-4}, 1);
  EXPECT_GT(d, 3e-4);
  EXPECT_LT(d, 4.5e-4);
}
}  // namespace
}  // namespace venato::dem
