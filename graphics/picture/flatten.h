#pragma once
/// Samples as stored in picture files -> Raster8 grey or RGB.
#include <cstdint>
#include <span>
#include <string>
#include "graphics/raster/raster.h"
namespace venato::graphics {

enum class Alpha { none, straight, premultiplied };
struct SampleLayout {
  int stride = 1;             ///< samples per pixel
  int colours = 1;            ///< 1 (grey) or 3 (RGB), the first ones
  Alpha alpha = Alpha::none;  ///< the sample after the colours
  bool white_is_zero = false;
  bool blue_first = false;  ///< BGR order
};
/// 16 bit is reduced to 8 (v / 257, rounded); alpha is composed on white in the stored (sRGB) values, as browsers do.
/// \param samples width * height * stride values of 8 or 16 bit \return pitch_m = 0
template <class T>
Raster8 flatten(std::span<const T> samples, int width, int height, const SampleLayout& layout);
template <class T>
Raster8 flatten(const std::vector<T>& samples, int width, int height, const SampleLayout& layout) {
  return flatten<T>(std::span<const T>(samples), width, height, layout);
}
/// "has 40000 x 40000 px = 1600 Mpx; limit 250 Mpx …"
std::string too_many_pixels(std::int64_t width, std::int64_t height, double max_pixels);
}  // namespace venato::graphics
