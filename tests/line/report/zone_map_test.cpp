#include "line/report/zone_map.h"
#include <gtest/gtest.h>
#include <limits>
namespace venato::line {
namespace {
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(ZoneMap, ShowsEveryZoneItsNumberAndTheCounts) {
  EXPECT_EQ(zone_map_html(ReportData{}), "");
  ReportData d;
  d.zones = {{"good", 0, 0, 200, 300, 0.4, 1.25, 0.98, 0.97},
             {"low_match", 200, 0, 200, 300, kNone, kNone, kNone, 0.31},
             {"no_evidence", 400, 0, 200, 300, kNone, kNone, kNone, kNone}};
  const std::string html = zone_map_html(d);
  EXPECT_NE(html.find("viewBox=\"0 0 420.0 210.0\""), std::string::npos) << html;  // 600 x 300 mm in 420 px
  EXPECT_NE(html.find(">1.2</text>"), std::string::npos);
  EXPECT_NE(html.find(">0 %</text>"), std::string::npos);  // no print there at all, whatever share of the body's length another zone's print finds
  EXPECT_NE(html.find("good: 1<"), std::string::npos);
  EXPECT_NE(html.find("outside tolerance: 0<"), std::string::npos);
  EXPECT_NE(html.find("no veins to judge by: 1<"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos) << html;
}
}  // namespace
}  // namespace venato::line
