#include "graphics/rectify/rectify.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
namespace venato::graphics {
namespace {
constexpr int kMostSamples = 16;
constexpr double kLeastVisible = 0.1;  // what registration asks for

/// Adds the bilinear value at (x, y), pixel centres at whole numbers; false outside the outer pixel centres.
bool add_sample(const Raster8& camera, const Eigen::Vector2d& at, double* sum) {
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() <= camera.width - 1 && at.y() <= camera.height - 1)) return false;
  const int i = std::min(static_cast<int>(at.x()), std::max(0, camera.width - 2)),
            j = std::min(static_cast<int>(at.y()), std::max(0, camera.height - 2));
  const int right = std::min(i + 1, camera.width - 1), below = std::min(j + 1, camera.height - 1);
  const double u = at.x() - i, v = at.y() - j;
  for (int c = 0; c < camera.channels; ++c)
    sum[c] += (1 - v) * ((1 - u) * camera.at(i, j, c) + u * camera.at(right, j, c)) +
              v * ((1 - u) * camera.at(i, below, c) + u * camera.at(right, below, c));
  return true;
}
}  // namespace

Rectified rectify(const Raster8& camera, const CameraView& view, int threads) {
  Rectified out;
  out.view = solve_view(view, camera.width, camera.height);
  const double across = view.pitch_m / out.view.finest_m_px;
  if (!(across <= kMostSamples))
    throw UsageError(view.file.string() + ": /pitch_mm: one pixel would cover " + std::to_string(std::lround(std::min(across, 1e9))) +
                     " pixels of the camera each way, the limit is 16; give a finer pitch_mm");
  const int n = std::clamp(static_cast<int>(std::ceil(across - 1e-9)), 1, kMostSamples);
  const double pitch = view.pitch_m;
  const int width = std::max(1, static_cast<int>(std::floor(view.width_m / pitch + 1e-6))),
            height = std::max(1, static_cast<int>(std::floor(view.height_m / pitch + 1e-6)));
  out.picture = Raster8(width, height, camera.channels, pitch);
  out.valid = Raster8(width, height, 1, pitch);
  std::vector<long> seen(static_cast<std::size_t>(height), 0);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const double x = (i + 0.5) * pitch, y = (j + 0.5) * pitch;
      if (std::min({x, y, view.width_m - x, view.height_m - y}) < view.margin_m) continue;
      double sum[4] = {};
      bool inside = true;
      for (int s = 0; s < n * n && inside; ++s) {
        Eigen::Vector2d at;
        inside = out.view.locate({(i + (s % n + 0.5) / n) * pitch, (j + (s / n + 0.5) / n) * pitch}, at) && add_sample(camera, at, sum);
      }
      if (!inside) continue;
      for (int c = 0; c < camera.channels; ++c) out.picture.at(i, j, c) = static_cast<std::uint8_t>(sum[c] / (n * n) + 0.5);
      out.valid.at(i, j) = 255;
      ++seen[static_cast<std::size_t>(j)];
    }
  double visible = 0;
  for (const long row : seen) visible += static_cast<double>(row);
  out.visible = visible / (static_cast<double>(width) * height);
  if (out.visible < kLeastVisible)
    throw UsageError(view.file.string() + ": only " + std::to_string(std::lround(100 * out.visible)) +
                     " % of the slab are in the picture (at least 10 % wanted): check marks, slab_mm and lens");
  return out;
}
}  // namespace venato::graphics
