#pragma once
/// What a TIFF directory claims, checked against limits and the file's real size. Internal to graphics/tiff.
#include <cstdint>
#include <filesystem>
#include "graphics/tiff/handle.h"
namespace venato::graphics::detail {

struct TiffLayout {
  std::int64_t width = 0, height = 0;
  int channels = 1, bits = 8;
  int sample_format = 1;  ///< SAMPLEFORMAT_*
  int photometric = 1, compression = 1;
  int extra_samples = 0;
  int first_extra = 0;  ///< EXTRASAMPLE_* of the first one
  bool planar = false, tiled = false;
  int ink_set = 0;
  double dpi_x = 0, dpi_y = 0;
};
/// \throws UsageError when sizes are missing or beyond any slab (1e11 px, 64 channels)
TiffLayout read_layout(tiff* t, const std::filesystem::path& file, const TiffLog& log);
/// \throws UsageError when the samples need more than max_bytes, strips lie beyond the end of the file, or the compressed bytes cannot hold
/// that many pixels (a few hundred bytes that claim gigabytes)
void check_data_is_there(tiff* t, const TiffLayout& layout, const std::filesystem::path& file, double max_bytes);
/// Interleaved samples of T (1, 2 or 4 bytes = layout.bits / 8), width * height * channels of them.
template <class T>
void decode_samples(tiff* t, const TiffLayout& layout, const std::filesystem::path& file, const TiffLog& log, T* out);
}  // namespace venato::graphics::detail
