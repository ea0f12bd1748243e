#include "graphics/raster/resample.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
namespace venato::graphics {
namespace {
template <class T>
T from_mean(double v) {
  if constexpr (std::is_integral_v<T>)
    return static_cast<T>(v + 0.5);
  else
    return static_cast<T>(v);
}
/// Overlap weights of target cell k (source pixels first .. first + weight.size() - 1).
struct Cell {
  int first = 0;
  std::vector<double> weight;
};
std::vector<Cell> cells(int source, int target, double ratio) {
  std::vector<Cell> out(static_cast<std::size_t>(target));
  for (int k = 0; k < target; ++k) {
    const double a = k * ratio, b = std::min<double>((k + 1) * ratio, source);
    Cell& c = out[static_cast<std::size_t>(k)];
    c.first = std::min(static_cast<int>(a), source - 1);
    for (int i = c.first; i < source && (i < b || c.weight.empty()); ++i) {
      const double overlap = std::min<double>(b, i + 1) - std::max<double>(a, i);
      if (overlap <= 1e-9 && !c.weight.empty()) break;
      c.weight.push_back(std::max(overlap, 1e-12));
    }
    double sum = 0;
    for (double w : c.weight) sum += w;
    for (double& w : c.weight) w /= sum;
  }
  return out;
}
/// Separable area average, row sums first so that the source is read once, in order.
template <class T>
Raster<T> area_average(const Raster<T>& in, int width, int height, double ratio) {
  Raster<T> out(width, height, in.channels, in.pitch_m * ratio);
  const auto across = cells(in.width, width, ratio), along = cells(in.height, height, ratio);
  const int n = in.channels;
#pragma omp parallel
  {
    std::vector<double> row(static_cast<std::size_t>(width * n));
#pragma omp for schedule(static)
    for (int j = 0; j < height; ++j) {
      std::fill(row.begin(), row.end(), 0.0);
      const Cell& v = along[static_cast<std::size_t>(j)];
      for (std::size_t b = 0; b < v.weight.size(); ++b) {
        const T* source = in.data.data() + in.index(0, v.first + static_cast<int>(b));
        for (int i = 0; i < width; ++i) {
          const Cell& h = across[static_cast<std::size_t>(i)];
          for (int c = 0; c < n; ++c) {
            double sum = 0;
            for (std::size_t a = 0; a < h.weight.size(); ++a) sum += h.weight[a] * source[(h.first + static_cast<int>(a)) * n + c];
            row[static_cast<std::size_t>(i * n + c)] += v.weight[b] * sum;
          }
        }
      }
      for (std::size_t k = 0; k < row.size(); ++k) out.data[out.index(0, j) + k] = from_mean<T>(row[k]);
    }
  }
  return out;
}
template <class T>
Raster<T> shrink_by(const Raster<T>& in, int factor) {
  VENATO_EXPECTS(factor >= 1 && !in.empty());
  if (factor == 1) return in;
  return area_average(in, (in.width + factor - 1) / factor, (in.height + factor - 1) / factor, factor);
}
template <class T>
Raster<T> to_width(const Raster<T>& in, int width) {
  VENATO_EXPECTS(width >= 1 && !in.empty());
  if (in.width <= width) return in;
  const double ratio = static_cast<double>(in.width) / width;
  return area_average(in, width, std::max(1, static_cast<int>(std::lround(in.height / ratio))), ratio);
}
template <class T>
Raster<T> cut(const Raster<T>& in, int x, int y, int width, int height) {
  VENATO_EXPECTS(x >= 0 && y >= 0 && width > 0 && height > 0 && x <= in.width - width && y <= in.height - height);
  Raster<T> out(width, height, in.channels, in.pitch_m);
  for (int j = 0; j < height; ++j)
    std::copy_n(in.data.begin() + static_cast<std::ptrdiff_t>(in.index(x, y + j)), width * in.channels,
                out.data.begin() + static_cast<std::ptrdiff_t>(out.index(0, j)));
  return out;
}
template <class T>
Raster<T> one_channel(const Raster<T>& in, int c) {
  VENATO_EXPECTS(c >= 0 && c < in.channels);
  Raster<T> out(in.width, in.height, 1, in.pitch_m);
  for (std::size_t k = 0; k < out.data.size(); ++k) out.data[k] = in.data[k * static_cast<std::size_t>(in.channels) + static_cast<std::size_t>(c)];
  return out;
}
}  // namespace

RasterF shrink(const RasterF& image, int factor) { return shrink_by(image, factor); }
Raster8 shrink(const Raster8& image, int factor) { return shrink_by(image, factor); }
Raster8 shrink_to_width(const Raster8& image, int width) { return to_width(image, width); }
RasterF shrink_to_width(const RasterF& image, int width) { return to_width(image, width); }
Raster8 crop(const Raster8& image, int x, int y, int width, int height) { return cut(image, x, y, width, height); }
RasterF crop(const RasterF& image, int x, int y, int width, int height) { return cut(image, x, y, width, height); }
RasterF channel(const RasterF& image, int c) { return one_channel(image, c); }
Raster8 channel(const Raster8& image, int c) { return one_channel(image, c); }
}  // namespace venato::graphics
