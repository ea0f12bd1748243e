#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>
namespace venato {

enum class SeriesStyle { line, points, steps, band };
struct Series {
  std::string label;
  std::vector<double> x, y;
  std::vector<double> y_low, y_high;  ///< band style or error bars; empty = none
  SeriesStyle style = SeriesStyle::line;
  std::string colour = "";  ///< "#rrggbb"; empty = next of a colour-blind-safe cycle
};
struct Plot {
  std::string title, x_label, y_label;  ///< labels with unit: "time [s]"
  std::vector<Series> series;
  std::optional<std::pair<double, double>> x_range, y_range;
};
/// Stand-alone SVG with round tick values, legend, grid; NaN points are left out. Same input, same bytes.
std::string svg_plot(const Plot& plot, int width_px = 640, int height_px = 360);
}  // namespace venato
