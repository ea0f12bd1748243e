#include "graphics/vein_map/vein_map.h"

#include <algorithm>

#include "graphics/colour/srgb.h"
namespace venato::graphics {

RasterF vein_fraction(const VeinMap& map) {
  const RasterF& f = map.fraction;
  VENATO_EXPECTS(map.body_powder >= 0 && map.body_powder < f.channels);
  RasterF out(f.width, f.height, 1, f.pitch_m);
  const auto n = static_cast<std::size_t>(f.channels), body = static_cast<std::size_t>(map.body_powder);
  for (std::size_t k = 0; k < out.data.size(); ++k) out.data[k] = std::clamp(1 - f.data[k * n + body], 0.0f, 1.0f);
  return out;
}

Raster8 colour_preview(const VeinMap& map) {
  const RasterF& f = map.fraction;
  VENATO_EXPECTS(map.colours.size() == static_cast<std::size_t>(f.channels));
  std::vector<std::array<double, 3>> linear(map.colours.size());
  for (std::size_t p = 0; p < linear.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c) linear[p][c] = srgb_to_linear(map.colours[p][c]);
  Raster8 out(f.width, f.height, 3, f.pitch_m);
  const auto pixels = static_cast<std::ptrdiff_t>(f.width) * f.height;
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t k = 0; k < pixels; ++k) {
    std::array<double, 3> sum{};
    double total = 0;
    for (std::size_t p = 0; p < linear.size(); ++p) {
      const double w = std::max(0.0f, f.data[static_cast<std::size_t>(k) * linear.size() + p]);
      total += w;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += w * linear[p][c];
    }
    // A pixel without any powder (outside the slab) shows white.
    for (std::size_t c = 0; c < 3; ++c) out.data[static_cast<std::size_t>(k) * 3 + c] = total > 0 ? linear_to_srgb(sum[c] / total) : 255;
  }
  return out;
}
}  // namespace venato::graphics
