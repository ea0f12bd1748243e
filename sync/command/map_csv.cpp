#include "sync/command/map_csv.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace venato::sync {
namespace {

double sample(const graphics::RasterF& raster, double x_m, double y_m) {
  if (raster.empty()) return std::nan("");
  const double x = std::clamp(x_m / raster.pitch_m - 0.5, 0.0, raster.width - 1.0),
               y = std::clamp(y_m / raster.pitch_m - 0.5, 0.0, raster.height - 1.0);
  const int i = static_cast<int>(x), j = static_cast<int>(y), i1 = std::min(i + 1, raster.width - 1), j1 = std::min(j + 1, raster.height - 1);
  const double fx = x - i, fy = y - j;
  return (1 - fy) * ((1 - fx) * raster.at(i, j) + fx * raster.at(i1, j)) + fy * ((1 - fx) * raster.at(i, j1) + fx * raster.at(i1, j1));
}

}  // namespace

std::string map_csv_text(const Transform& print_from_green, const graphics::RasterF& sigma_m, double width_m, double height_m, double step_m) {
  constexpr double slack = 1e-9;  // a slab of exactly k steps keeps its last point whatever rounding says
  const int columns = 1 + static_cast<int>(std::floor(width_m / step_m + slack)), rows = 1 + static_cast<int>(std::floor(height_m / step_m + slack));
  std::string out = "x_green_mm,y_green_mm,x_graphic_mm,y_graphic_mm,sigma_mm\n";
  char line[160];
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const Point green(i * step_m, j * step_m), print = print_from_green(green);
      const double sigma = sample(sigma_m, green.x(), green.y());
      std::snprintf(line, sizeof line, "%.3f,%.3f,%.4f,%.4f,", green.x() * 1e3, green.y() * 1e3, print.x() * 1e3, print.y() * 1e3);
      out += line;
      if (std::isfinite(sigma)) {
        std::snprintf(line, sizeof line, "%.4f\n", sigma * 1e3);
        out += line;
      } else {
        out += "nan\n";
      }
    }
  return out;
}

}  // namespace venato::sync
