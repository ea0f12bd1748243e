#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/rng.h"
#include "graphics/raster/raster.h"
#include "sync/transform/transform.h"

namespace venato::sync::test {

/// Vein-like curves that can be evaluated anywhere: the zero lines of a sum of plane waves. No two seeds have anything in common.
class VeinField {
 public:
  explicit VeinField(std::uint64_t seed) {
    Rng rng(seed, stream_id("test/command/veins"));
    for (int k = 0; k < 24; ++k) {
      const double wavelength_m = 0.07 + 0.16 * rng.uniform(), angle = 6.283185307 * rng.uniform();
      waves_.push_back({6.283185307 / wavelength_m * std::cos(angle), 6.283185307 / wavelength_m * std::sin(angle), 6.283185307 * rng.uniform()});
    }
  }
  /// Soft vein of half width `half_m` around the zero lines; 0..1.
  double fraction(Point p, double half_m = 0.006) const {
    double f = 0, gx = 0, gy = 0;
    for (const auto& w : waves_) {
      const double phase = w[0] * p.x() + w[1] * p.y() + w[2];
      f += std::sin(phase);
      gx += w[0] * std::cos(phase);
      gy += w[1] * std::cos(phase);
    }
    const double distance_m = std::abs(f) / (std::hypot(gx, gy) + 60);  // first-order distance; blunted where the gradient vanishes
    return std::clamp(0.5 + (half_m - distance_m) / 0.003, 0.0, 1.0);
  }

 private:
  std::vector<std::array<double, 3>> waves_;
};

/// One channel of vein fraction seen through `print_from_green`.
inline graphics::RasterF vein_raster(const VeinField& field, const Transform& print_from_green, int width, int height, double pitch_m) {
  graphics::RasterF out(width, height, 1, pitch_m);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      out.at(i, j) = static_cast<float>(field.fraction(print_from_green(Point((i + 0.5) * pitch_m, (j + 0.5) * pitch_m))));
  return out;
}

/// Grey-brown veins on a white body with grain.
inline graphics::Raster8 painted(const graphics::RasterF& fraction, std::uint64_t seed) {
  graphics::Raster8 out(fraction.width, fraction.height, 3, fraction.pitch_m);
  Rng rng(seed, stream_id("test/command/grain"));
  for (std::size_t k = 0; k < fraction.data.size(); ++k) {
    const double grain = 4 * rng.normal();
    const double body[] = {238, 235, 228}, vein[] = {120, 112, 104};
    for (std::size_t c = 0; c < 3; ++c)
      out.data[3 * k + c] = static_cast<std::uint8_t>(std::clamp(body[c] + (vein[c] - body[c]) * fraction.data[k] + grain, 0.0, 255.0));
  }
  return out;
}

/// Half a degree, a shift, and a smooth displacement of a few millimetres over width x height.
inline Transform known_map(double width_m, double height_m, double amplitude_m = 0.004) {
  Transform map;
  map.a << std::cos(0.0087), -std::sin(0.0087), std::sin(0.0087), std::cos(0.0087);
  map.t = Point(0.018, 0.012);
  map.u = make_zero_field(width_m, height_m, 0.150);
  Rng rng(11, stream_id("test/command/map"));
  for (auto* c : {&map.u.cx, &map.u.cy})
    for (double& v : *c) v = amplitude_m * (2 * rng.uniform() - 1);
  return map;
}
}  // namespace venato::sync::test
