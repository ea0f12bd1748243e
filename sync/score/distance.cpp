#include "sync/score/distance.h"
#include <cmath>
#include <limits>
#include <vector>
namespace venato::sync {
namespace {
constexpr double kFar = 1e20;  // stands for infinity inside the parabola arithmetic

/// Lower envelope of parabolas: d(p) = min_q (p - q)^2 + f(q).
void transform_line(const std::vector<double>& f, std::vector<double>& d, std::vector<int>& vertex, std::vector<double>& border) {
  const int n = static_cast<int>(f.size());
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  int k = 0;
  vertex[0] = 0;
  border[0] = -kFar;
  border[1] = kFar;
  for (int q = 1; q < n; ++q) {
    const auto meet = [&](int v) { return ((f[at(q)] + static_cast<double>(q) * q) - (f[at(v)] + static_cast<double>(v) * v)) / (2.0 * (q - v)); };
    double s = meet(vertex[at(k)]);
    while (k > 0 && s <= border[at(k)]) s = meet(vertex[at(--k)]);
    vertex[at(++k)] = q;
    border[at(k)] = s;
    border[at(k + 1)] = kFar;
  }
  k = 0;
  for (int p = 0; p < n; ++p) {
    while (border[at(k + 1)] < p) ++k;
    const double gap = p - vertex[at(k)];
    d[at(p)] = gap * gap + f[at(vertex[at(k)])];
  }
}
}  // namespace

graphics::RasterF distance_to(const graphics::Raster8& set) {
  const int w = set.width, h = set.height;
  graphics::RasterF out(w, h, 1, set.pitch_m, std::numeric_limits<float>::infinity());
  if (set.empty()) return out;
  std::vector<double> squared(set.data.size());
  bool any = false;
  for (std::size_t k = 0; k < set.data.size(); ++k) {
    squared[k] = set.data[k] ? 0 : kFar;
    any = any || set.data[k];
  }
  if (!any) return out;
  const auto line = [&](int n, auto index) {
    std::vector<double> f(static_cast<std::size_t>(n)), d(f.size()), border(f.size() + 1);
    std::vector<int> vertex(f.size());
    for (int i = 0; i < n; ++i) f[static_cast<std::size_t>(i)] = squared[index(i)];
    transform_line(f, d, vertex, border);
    for (int i = 0; i < n; ++i) squared[index(i)] = d[static_cast<std::size_t>(i)];
  };
  for (int i = 0; i < w; ++i) line(h, [&](int j) { return set.index(i, j); });
  for (int j = 0; j < h; ++j) line(w, [&](int i) { return set.index(i, j); });
  for (std::size_t k = 0; k < squared.size(); ++k) out.data[k] = static_cast<float>(std::sqrt(squared[k]));
  return out;
}

graphics::Raster8 boundary(const graphics::Raster8& mask) {
  graphics::Raster8 out(mask.width, mask.height, 1, mask.pitch_m);
  const auto inside = [&](int i, int j) { return i < 0 || j < 0 || i >= mask.width || j >= mask.height || mask.at(i, j); };
  for (int j = 0; j < mask.height; ++j)
    for (int i = 0; i < mask.width; ++i)
      if (mask.at(i, j) && !(inside(i - 1, j) && inside(i + 1, j) && inside(i, j - 1) && inside(i, j + 1))) out.at(i, j) = 255;
  return out;
}
}  // namespace venato::sync
