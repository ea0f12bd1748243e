#include "line/press_map/gaussian_blur.h"

#include <cmath>
#include <vector>

namespace venato::line {
namespace {
int mirrored(int i, int n) {
  while (i < 0 || i >= n) i = i < 0 ? -1 - i : 2 * n - 1 - i;
  return i;
}

// Weights of the cells of a Gaussian: differences of the error function, so that a narrow one keeps its variance.
std::vector<double> weights_of(double sigma_px) {
  const int reach = std::max(1, static_cast<int>(std::ceil(4 * sigma_px)));
  std::vector<double> w(static_cast<std::size_t>(reach) + 1);
  // A cell average adds 1/12 px^2 of its own: take it off where there is enough.
  const double s = std::sqrt(std::max(sigma_px * sigma_px - 1.0 / 12, 0.01 * sigma_px * sigma_px)) * std::sqrt(2.0);
  double sum = 0;
  for (int e = 0; e <= reach; ++e) {
    w[static_cast<std::size_t>(e)] = 0.5 * (std::erf((e + 0.5) / s) - std::erf((e - 0.5) / s));
    sum += (e == 0 ? 1 : 2) * w[static_cast<std::size_t>(e)];
  }
  for (double& x : w) x /= sum;
  return w;
}
}  // namespace

void blur_gaussian(graphics::RasterF& raster, double sigma_m, int threads) {
  const double sigma_px = sigma_m / raster.pitch_m;
  if (!(sigma_px >= 0.05)) return;
  const std::vector<double> w = weights_of(sigma_px);
  const int reach = static_cast<int>(w.size()) - 1;
  graphics::RasterF half = raster;
  const auto pass = [&](const graphics::RasterF& from, graphics::RasterF& to, int along_x) {
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int j = 0; j < from.height; ++j)
      for (int i = 0; i < from.width; ++i)
        for (int c = 0; c < from.channels; ++c) {
          double sum = 0;
          for (int e = -reach; e <= reach; ++e)
            sum += w[static_cast<std::size_t>(std::abs(e))] *
                   (along_x ? from.at(mirrored(i + e, from.width), j, c) : from.at(i, mirrored(j + e, from.height), c));
          to.at(i, j, c) = static_cast<float>(sum);
        }
  };
  pass(raster, half, 1);
  pass(half, raster, 0);
}
}  // namespace venato::line
