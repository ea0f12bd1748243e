#include "line/press_map/sample_slab.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/expects.h"
#include "line/press_map/column_sampler.h"
#include "line/press_map/gaussian_blur.h"

namespace venato::line {
namespace {
[[noreturn]] void refuse_empty() { throw WorkError("the pressed bed holds no powder somewhere under the slab; only a full bed makes a slab"); }

double bilinear(const graphics::RasterF& r, double x_m, double y_m, int channel) {
  const double a = std::clamp(x_m / r.pitch_m - 0.5, 0.0, r.width - 1.0), b = std::clamp(y_m / r.pitch_m - 0.5, 0.0, r.height - 1.0);
  const int i = static_cast<int>(a), j = static_cast<int>(b), i2 = std::min(i + 1, r.width - 1), j2 = std::min(j + 1, r.height - 1);
  const double f = a - i, g = b - j;
  return (r.at(i, j, channel) * (1 - f) + r.at(i2, j, channel) * f) * (1 - g) + (r.at(i, j2, channel) * (1 - f) + r.at(i2, j2, channel) * f) * g;
}
}  // namespace

graphics::RasterF sample_layer_fraction(const Slab& slab, double depth_m, double blur_sigma_m, int threads) {
  const graphics::RasterF& where = slab.belt_from_green_m;
  VENATO_EXPECTS(!where.empty() && where.channels == 2 && threads >= 1);
  const float thinnest = *std::min_element(slab.thickness_m.data.begin(), slab.thickness_m.data.end());
  if (!(depth_m >= 0 && depth_m <= thinnest))
    throw UsageError("polishing depth " + std::to_string(depth_m * 1e3) + " mm is outside the slab of " + std::to_string(thinnest * 1e3) + " mm");
  const std::size_t powders = slab.bed.powders.size();
  const ColumnSampler sampler(slab.bed);
  graphics::RasterF out(where.width, where.height, static_cast<int>(powders), where.pitch_m);
  std::atomic<bool> empty = false;
#pragma omp parallel num_threads(threads)
  {
    std::vector<double> fractions(powders);
#pragma omp for schedule(static)
    for (int j = 0; j < where.height; ++j)
      for (int i = 0; i < where.width; ++i) {
        if (!sampler.sample(where.at(i, j, 0), where.at(i, j, 1), depth_m / slab.thickness_m.at(i, j), fractions.data())) empty = true;
        for (std::size_t k = 0; k < powders; ++k) out.at(i, j, static_cast<int>(k)) = static_cast<float>(fractions[k]);
      }
  }
  if (empty) refuse_empty();
  blur_gaussian(out, blur_sigma_m < 0 ? slab.sigma_nonaffine_m : blur_sigma_m, threads);
  return out;
}

graphics::RasterF sample_section(const Slab& slab, double x0_m, double y0_m, double x1_m, double y1_m, double pitch_m) {
  const graphics::RasterF& where = slab.belt_from_green_m;
  VENATO_EXPECTS(!where.empty() && pitch_m > 0);
  const double length = std::hypot(x1_m - x0_m, y1_m - y0_m);
  for (const double x : {x0_m, x1_m})
    for (const double y : {y0_m, y1_m})
      if (!(x >= 0 && y >= 0 && x <= where.width_m() + 1e-9 && y <= where.height_m() + 1e-9))
        throw UsageError("section through (" + std::to_string(x) + ", " + std::to_string(y) + ") m lies outside the slab of " +
                         std::to_string(where.width_m()) + " x " + std::to_string(where.height_m()) + " m");
  if (!(length >= pitch_m))
    throw UsageError("section of " + std::to_string(length) + " m is shorter than a pixel of " + std::to_string(pitch_m) + " m");
  const double thickest = *std::max_element(slab.thickness_m.data.begin(), slab.thickness_m.data.end());
  const int columns = static_cast<int>(std::ceil(length / pitch_m - 1e-6)),
            rows = std::max(1, static_cast<int>(std::ceil(thickest / pitch_m - 1e-6)));
  const ColumnSampler sampler(slab.bed);
  std::vector<double> fractions(slab.bed.powders.size());
  graphics::RasterF out(columns, rows, static_cast<int>(fractions.size()), pitch_m);
  for (int i = 0; i < columns; ++i) {
    const double t = std::min(1.0, (i + 0.5) * pitch_m / length), x = x0_m + t * (x1_m - x0_m), y = y0_m + t * (y1_m - y0_m);
    const double belt_x = bilinear(where, x, y, 0), belt_y = bilinear(where, x, y, 1), thickness = bilinear(slab.thickness_m, x, y, 0);
    for (int j = 0; j < rows; ++j) {
      if (!sampler.sample(belt_x, belt_y, std::min(1.0, (j + 0.5) * pitch_m / thickness), fractions.data())) refuse_empty();
      for (std::size_t k = 0; k < fractions.size(); ++k) out.at(i, j, static_cast<int>(k)) = static_cast<float>(fractions[k]);
    }
  }
  return out;
}
}  // namespace venato::line
