#include "graphics/plan/background.h"

#include <algorithm>
#include <cmath>

#include "graphics/colour/srgb.h"
#include "graphics/raster/mask.h"
#include "graphics/raster/resample.h"
namespace venato::graphics {
namespace {
constexpr double kCellsPerWindow = 24;  // the background is smooth: 5 mm cells for a 120 mm window
constexpr double kSmoothingOfWindow = 0.2;
}  // namespace

RasterF lightness(const Raster8& srgb) {
  RasterF out(srgb.width, srgb.height, 1, srgb.pitch_m);
  const auto pixels = static_cast<std::ptrdiff_t>(out.data.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t k = 0; k < pixels; ++k) {
    const std::uint8_t* p = srgb.data.data() + k * srgb.channels;
    const Srgb8 c = srgb.channels == 1 ? Srgb8{p[0], p[0], p[0]} : Srgb8{p[0], p[1], p[2]};
    out.data[static_cast<std::size_t>(k)] = static_cast<float>(lab_from_srgb(c).l / 100);
  }
  return out;
}

RasterF local_background(const RasterF& image, double window_m, double rank) {
  const int factor = std::max(1, static_cast<int>(std::lround(window_m / kCellsPerWindow / image.pitch_m)));
  const RasterF coarse = shrink(image, factor);
  const int half = std::max(1, static_cast<int>(std::lround(window_m / coarse.pitch_m / 2)));
  RasterF ranked = coarse;
#pragma omp parallel for schedule(static)
  for (int j = 0; j < coarse.height; ++j) {
    std::vector<float> window;
    for (int i = 0; i < coarse.width; ++i) {
      window.clear();
      for (int y = std::max(0, j - half); y <= std::min(coarse.height - 1, j + half); ++y)
        for (int x = std::max(0, i - half); x <= std::min(coarse.width - 1, i + half); ++x) window.push_back(coarse.at(x, y));
      const auto nth = window.begin() + static_cast<std::ptrdiff_t>(rank * static_cast<double>(window.size() - 1));
      std::nth_element(window.begin(), nth, window.end());
      ranked.at(i, j) = *nth;
    }
  }
  ranked = gaussian(ranked, kSmoothingOfWindow * window_m / coarse.pitch_m);
  RasterF out(image.width, image.height, 1, image.pitch_m);
  const auto split = [&](int k, int cells, int& a, int& b, float& t) {  // bilinear, constant beyond the outer cell centres
    const double at = std::clamp((k + 0.5) / factor - 0.5, 0.0, static_cast<double>(cells - 1));
    a = static_cast<int>(at);
    b = std::min(a + 1, cells - 1);
    t = static_cast<float>(at - a);
  };
#pragma omp parallel for schedule(static)
  for (int j = 0; j < image.height; ++j) {
    int y0 = 0, y1 = 0, x0 = 0, x1 = 0;
    float v = 0, u = 0;
    split(j, ranked.height, y0, y1, v);
    for (int i = 0; i < image.width; ++i) {
      split(i, ranked.width, x0, x1, u);
      out.at(i, j) = (1 - v) * ((1 - u) * ranked.at(x0, y0) + u * ranked.at(x1, y0)) + v * ((1 - u) * ranked.at(x0, y1) + u * ranked.at(x1, y1));
    }
  }
  return out;
}
}  // namespace venato::graphics
