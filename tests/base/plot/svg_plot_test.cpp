#include "base/plot/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/plot/ticks.h"

namespace venato {
namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

Plot sample() {
  Plot p;
  p.title = "mass < 1 & more";
  p.x_label = "time [s]";
  p.y_label = "mass [kg]";
  p.series.push_back({"measured", {0, 1, 2, 3}, {1, kNan, 3, 2}, {}, {}, SeriesStyle::line, ""});
  p.series.push_back({"rig", {0, 1, 2}, {1, 2, kNan}, {0.5, 1.5, 2}, {1.5, 2.5, 4}, SeriesStyle::points, "#ff0000"});
  p.series.push_back({"95 %", {0, 1, 2}, {1, 2, 3}, {0, 1, 2}, {2, 3, 4}, SeriesStyle::band, ""});
  return p;
}
}  // namespace

TEST(SvgPlot, ShowsWhatItIsGivenAndNoNan) {
  const std::string svg = svg_plot(sample());
  EXPECT_EQ(svg.rfind("<svg xmlns=", 0), 0u);
  EXPECT_EQ(count(svg, "<svg"), count(svg, "</svg>"));
  EXPECT_EQ(count(svg, "<circle"), 2);  // the NaN point is left out
  EXPECT_NE(svg.find("mass &lt; 1 &amp; more"), std::string::npos);
  EXPECT_NE(svg.find("time [s]"), std::string::npos);
  EXPECT_NE(svg.find("measured"), std::string::npos);
  EXPECT_NE(svg.find("#ff0000"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(SvgPlot, SameInputSameBytes) { EXPECT_EQ(svg_plot(sample()), svg_plot(sample())); }

TEST(SvgPlot, NanInterruptsTheLine) {
  Plot p;
  p.series.push_back({"", {0, 1, 2, 3, 4}, {1, 2, kNan, 1, 2}, {}, {}, SeriesStyle::line, "#123456"});
  const std::string svg = svg_plot(p);
  const auto end = svg.find("stroke=\"#123456\"");
  const auto begin = svg.rfind("<path", end);
  EXPECT_EQ(count(svg.substr(begin, end - begin), "M"), 2);
}

TEST(SvgPlot, DegenerateInputStillDraws) {
  Plot p;
  EXPECT_NE(svg_plot(p).find("</svg>"), std::string::npos);
  p.series.push_back({"one", {1}, {5}, {}, {}, SeriesStyle::points, ""});
  EXPECT_EQ(count(svg_plot(p), "<circle"), 1);
  p.series[0] = {"all nan", {kNan, 1}, {1, kNan}, {}, {}, SeriesStyle::line, ""};
  EXPECT_EQ(svg_plot(p).find("nan\""), std::string::npos);
  p.series[0] = {"short y", {1, 2, 3}, {1}, {}, {}, SeriesStyle::line, ""};
  EXPECT_NE(svg_plot(p).find("</svg>"), std::string::npos);
  p.series[0] = {"huge", {1e17, 1e17 + 64}, {1, 2}, {}, {}, SeriesStyle::line, ""};
  EXPECT_NE(svg_plot(p).find("</svg>"), std::string::npos);
}

TEST(Ticks, AreRoundAndInside) {
  const Ticks t = round_ticks(0, 1, 5);
  EXPECT_EQ(t.labels, (std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{{-3.7, 12.2}, {1e-9, 5e-9}, {-1e8, 1e8}, {99.9, 100.1}}) {
    const Ticks some = round_ticks(low, high, 6);
    ASSERT_GE(some.values.size(), 2u);
    EXPECT_LE(some.values.size(), 13u);
    // Rounding of multiples of the step: 1e-8 of the range.
    EXPECT_GE(some.values.front(), low - 1e-8 * (high - low));
    EXPECT_LE(some.values.back(), high + 1e-8 * (high - low));
  }
}
}  // namespace venato
