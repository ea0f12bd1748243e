#include "graphics/picture/flatten.h"

#include <algorithm>
#include <limits>
namespace venato::graphics {

template <class T>
Raster8 flatten(std::span<const T> samples, int width, int height, const SampleLayout& layout) {
  Raster8 out(width, height, layout.colours, 0);
  VENATO_EXPECTS(samples.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(layout.stride));
  constexpr std::uint32_t full = std::numeric_limits<T>::max();
  const auto colours = static_cast<std::size_t>(layout.colours), stride = static_cast<std::size_t>(layout.stride);
  const std::size_t pixels = samples.size() / stride;
  for (std::size_t p = 0; p < pixels; ++p) {
    const T* in = samples.data() + p * stride;
    const std::uint32_t alpha = layout.alpha == Alpha::none ? full : in[colours];
    for (std::size_t c = 0; c < colours; ++c) {
      std::uint64_t v = in[layout.blue_first ? colours - 1 - c : c];
      if (layout.white_is_zero) v = full - v;
      if (layout.alpha == Alpha::straight)
        v = (v * alpha + static_cast<std::uint64_t>(full) * (full - alpha) + full / 2) / full;
      else if (layout.alpha == Alpha::premultiplied)
        v = std::min<std::uint64_t>(full, v + (full - alpha));
      out.data[p * colours + c] = static_cast<std::uint8_t>((v * 255 + full / 2) / full);
    }
  }
  return out;
}
template Raster8 flatten<std::uint8_t>(std::span<const std::uint8_t>, int, int, const SampleLayout&);
template Raster8 flatten<std::uint16_t>(std::span<const std::uint16_t>, int, int, const SampleLayout&);

std::string too_many_pixels(std::int64_t width, std::int64_t height, double max_pixels) {
  const auto mega = [](double v) { return std::to_string(static_cast<long long>(v / 1e6)); };
  return "has " + std::to_string(width) + " x " + std::to_string(height) + " px = " + mega(static_cast<double>(width) * static_cast<double>(height)) +
         " Mpx; limit " + mega(max_pixels) + " Mpx; reduce the picture";
}
}  // namespace venato::graphics
