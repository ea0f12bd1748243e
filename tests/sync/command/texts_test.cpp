#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sync/command/map_csv.h"
#include "sync/command/score_text.h"

namespace venato::sync {
namespace {

using nlohmann::json;

TEST(ScoreText, ConvertsToMillimetresAndWritesNullForNothing) {
  ScoreReport report;
  Metrics m;
  m.centreline_median_m = 0.00012345678;
  m.centreline_p95_m = 0.0021;
  m.matched_length = 0.93;
  m.boundary_f1_1mm = 0.4;
  m.boundary_f1_2mm = 0.7;
  m.boundary_f1_3mm = 0.9;
  m.dice = 0.81;
  report.before = m;
  m.centreline_median_m = std::numeric_limits<double>::quiet_NaN();
  m.centreline_p95_m = std::numeric_limits<double>::infinity();
  report.after = m;
  report.visibility = VisibilityReport{{{10, 20, 30}, {200, 190, 180}, 40.5}, 2.3, {}, {}};
  Visibility seen;
  seen.distance_m = 0.5, seen.delta_e_mean = 3.5, seen.delta_e_p95 = std::numeric_limits<double>::quiet_NaN(), seen.area_over_1 = 0.25,
  seen.area_over_2 = 0.125;
  seen.displaced_length_m = 0.2, seen.extra_length_m = 0.05, seen.missing_length_m = 0.01, seen.print_length_m = 1;
  report.visibility->before.push_back(seen);
  report.body_edge = EdgeWidths{0.0042, 0.009, 0.8};
  Registration registration;
  registration.success = false;
  registration.reason = "T2: \"peak\" 1.2 < 1.6";
  registration.confidence = 0.25;
  registration.gates.push_back({"T2", 1.2, 1.6, false, "peak ratio"});
  const json j = json::parse(score_json_text(report, registration));
  EXPECT_NEAR(j.at("before").at("centreline_error_mm").at("median").get<double>(), 0.123457, 1e-9);
  EXPECT_NEAR(j.at("before").at("centreline_error_mm").at("p95").get<double>(), 2.1, 1e-9);
  EXPECT_EQ(j.at("before").at("matched_length"), 0.93);
  EXPECT_EQ(j.at("before").at("boundary_f1").at("1mm"), 0.4);
  EXPECT_EQ(j.at("before").at("boundary_f1").at("2mm"), 0.7);
  EXPECT_EQ(j.at("before").at("boundary_f1").at("3mm"), 0.9);
  EXPECT_EQ(j.at("before").at("dice"), 0.81);
  EXPECT_EQ(j.at("before").size(), 4u) << "the contract's keys and no others";
  EXPECT_TRUE(j.at("after").at("centreline_error_mm").at("median").is_null());
  EXPECT_TRUE(j.at("after").at("centreline_error_mm").at("p95").is_null());
  EXPECT_EQ(j.at("after").at("dice"), 0.81);
  EXPECT_TRUE(j.at("best_reachable").at("dice").is_null());
  EXPECT_EQ(j.at("registration"), (json{{"success", false}, {"reason", "T2: \"peak\" 1.2 < 1.6"}, {"confidence", 0.25}}));
  EXPECT_NEAR(j.at("details").at("edge_width_10_90_mm").at("body").at("median").get<double>(), 4.2, 1e-9);
  EXPECT_TRUE(j.at("details").at("edge_width_10_90_mm").at("print").is_null());
  const json& visibility = j.at("details").at("visibility");
  EXPECT_EQ(visibility.at("vein_srgb"), (json{10, 20, 30}));
  EXPECT_TRUE(visibility.at("after").is_null());
  const json& v = visibility.at("before").at(0);
  EXPECT_EQ(v.at("distance_m"), 0.5);
  EXPECT_TRUE(v.at("delta_e2000_p95").is_null());
  EXPECT_EQ(v.at("area_over_1_percent"), 25);
  EXPECT_EQ(v.at("area_over_2_percent"), 12.5);
  EXPECT_EQ(v.at("visible_length_mm"), 250);
  EXPECT_EQ(v.at("visible_length_percent"), 25);
  EXPECT_EQ(v.at("missing_visible_length_mm"), 10);
  report.visibility.reset();
  EXPECT_TRUE(json::parse(score_json_text(report, registration)).at("details").at("visibility").is_null());
  EXPECT_EQ(j.at("details").at("gates")[0].at("name"), "T2");
}

TEST(MapCsv, GridHoldsBothEndsAndMillimetres) {
  Transform map;
  map.t = Point(0.001, -0.002);
  graphics::RasterF sigma(3, 2, 1, 0.010);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 3; ++i) sigma.at(i, j) = 0.001f * static_cast<float>(1 + i);
  std::istringstream text(map_csv_text(map, sigma, 0.030, 0.0199));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 1u + 4u * 2u);
  EXPECT_EQ(lines[0], "x_green_mm,y_green_mm,x_graphic_mm,y_graphic_mm,sigma_mm");
  EXPECT_EQ(lines[1], "0.000,0.000,1.0000,-2.0000,1.0000");
  EXPECT_EQ(lines[2], "10.000,0.000,11.0000,-2.0000,1.5000");  // half way between two sigma cells
  EXPECT_EQ(lines[5], "0.000,10.000,1.0000,8.0000,1.0000");
  EXPECT_EQ(lines[8], "30.000,10.000,31.0000,8.0000,3.0000");
  EXPECT_NE(map_csv_text(map, {}, 0.01, 0.01).find(",nan\n"), std::string::npos);
}

}  // namespace
}  // namespace venato::sync
