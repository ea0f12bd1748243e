#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>
#include "base/expects.h"
namespace venato::graphics {

/// Image with a physical pitch. Row j runs along the belt (y, downstream), column i across it (x); the centre of pixel (i, j) lies at
/// ((i + 1/2) * pitch_m, (j + 1/2) * pitch_m) from the frame's origin, its top-left corner. Channels are interleaved.
template <class T>
struct Raster {
  int width = 0, height = 0, channels = 1;
  double pitch_m = 0;  ///< square pixels
  std::vector<T> data;

  Raster() = default;
  Raster(int w, int h, int c, double pitch, T fill = T{})
      : width(w),
        height(h),
        channels(c),
        pitch_m(pitch),
        data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c), fill) {}
  std::size_t index(int i, int j, int c = 0) const {
    return (static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)) * static_cast<std::size_t>(channels) +
           static_cast<std::size_t>(c);
  }
  T& at(int i, int j, int c = 0) { return data[index(i, j, c)]; }
  const T& at(int i, int j, int c = 0) const { return data[index(i, j, c)]; }
  bool empty() const { return data.empty(); }
  double width_m() const { return width * pitch_m; }
  double height_m() const { return height * pitch_m; }
};
using RasterF = Raster<float>;
using Raster8 = Raster<std::uint8_t>;
}  // namespace venato::graphics
