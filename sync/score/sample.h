#pragma once
#include <algorithm>
#include "graphics/raster/raster.h"
#include "sync/transform/transform.h"
namespace venato::sync {
/// Bilinear value of a one-channel raster at `px` (pixel centres at integers); the rim continues outward. \pre not empty
inline double bilinear(const graphics::RasterF& f, Point px) {
  const double x = std::clamp(px.x(), 0.0, f.width - 1.0), y = std::clamp(px.y(), 0.0, f.height - 1.0);
  const int i = std::min(static_cast<int>(x), std::max(0, f.width - 2)), j = std::min(static_cast<int>(y), std::max(0, f.height - 2));
  const int i1 = std::min(i + 1, f.width - 1), j1 = std::min(j + 1, f.height - 1);
  const double fx = x - i, fy = y - j;
  return (1 - fy) * ((1 - fx) * static_cast<double>(f.at(i, j)) + fx * static_cast<double>(f.at(i1, j))) +
         fy * ((1 - fx) * static_cast<double>(f.at(i, j1)) + fx * static_cast<double>(f.at(i1, j1)));
}
}  // namespace venato::sync
