#include "line/chain/cut_to_slab.h"

#include <algorithm>
#include <cmath>
namespace venato::line {
using graphics::Raster8;

Raster8 cut_to_slab(const Raster8& source, double source_pitch_m, double origin_x_m, double origin_y_m, double width_m, double height_m,
                    double out_from_source, const sync::Transform& placement, int channels) {
  const int width = std::max(1, static_cast<int>(std::lround(width_m / source_pitch_m))),
            height = std::max(1, static_cast<int>(std::lround(height_m / source_pitch_m)));
  Raster8 out(width, height, channels, source_pitch_m * out_from_source);
  const Eigen::Matrix2d back = placement.a.transpose();  // a rotation
  const auto value = [&](int i, int j, int c) {
    i = std::clamp(i, 0, source.width - 1);
    j = std::clamp(j, 0, source.height - 1);
    return static_cast<double>(source.at(i, j, source.channels == 1 ? 0 : c));
  };
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const sync::Point p((i + 0.5) * out.pitch_m, (j + 0.5) * out.pitch_m);
      const sync::Point content = back * (p - placement.t) / out_from_source;
      const double x = (content.x() + origin_x_m) / source_pitch_m - 0.5, y = (content.y() + origin_y_m) / source_pitch_m - 0.5;
      // Positions that are whole pixels but for rounding are copied exactly.
      const int i0 = static_cast<int>(std::floor(x + 1e-6)), j0 = static_cast<int>(std::floor(y + 1e-6));
      const double fx = std::max(0.0, x - i0), fy = std::max(0.0, y - j0);
      for (int c = 0; c < channels; ++c) {
        const double top = value(i0, j0, c) * (1 - fx) + value(i0 + 1, j0, c) * fx,
                     bottom = value(i0, j0 + 1, c) * (1 - fx) + value(i0 + 1, j0 + 1, c) * fx;
        out.at(i, j, c) = static_cast<std::uint8_t>(std::lround(top * (1 - fy) + bottom * fy));
      }
    }
  return out;
}
}  // namespace venato::line
