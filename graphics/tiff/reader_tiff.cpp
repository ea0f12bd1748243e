#include <tiffio.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "graphics/tiff/layout.h"
#include "graphics/tiff/tiff_file.h"
namespace venato::graphics {
namespace {
constexpr double kSquareTolerance = 1e-3;  // rational rounding of X and Y resolution

double square_dpi(const detail::TiffLayout& l) { return l.dpi_x > 0 && std::abs(l.dpi_x - l.dpi_y) <= kSquareTolerance * l.dpi_x ? l.dpi_x : 0; }
bool is_float(const detail::TiffLayout& l) { return l.sample_format == SAMPLEFORMAT_IEEEFP && l.bits == 32; }

TiffKind kind_of(const detail::TiffLayout& l) {
  if (is_float(l)) return TiffKind::fractions_f32;
  if (l.photometric == PHOTOMETRIC_SEPARATED) return TiffKind::separated;
  return l.photometric == PHOTOMETRIC_RGB ? TiffKind::rgb : TiffKind::grey;
}
TiffCompression compression_of(const detail::TiffLayout& l) {
  if (l.compression == COMPRESSION_LZW) return TiffCompression::lzw;
  if (l.compression == COMPRESSION_PACKBITS) return TiffCompression::packbits;
  if (l.compression == COMPRESSION_NONE) return TiffCompression::none;
  return TiffCompression::deflate;
}
/// NUL-separated; libtiff hands over the tag with a terminating NUL and as many names as the tag has.
std::vector<std::string> ink_names(tiff* t, int channels) {
  std::vector<std::string> names;
  std::uint16_t count = 0;
  char* text = nullptr;
  if (!TIFFGetField(t, TIFFTAG_NUMBEROFINKS, &count) || !TIFFGetField(t, TIFFTAG_INKNAMES, &text) || !text) return names;
  for (int k = 0; k < std::min<int>(count, channels); ++k) {
    names.emplace_back(text);
    text += names.back().size() + 1;
  }
  return names;
}
template <class T>
Raster<T> read_all(const std::filesystem::path& file, double max_bytes, bool wanted(const detail::TiffLayout&), const char* wanted_name) {
  detail::TiffLog log;
  const auto t = detail::open_tiff_reader(file, log);
  const auto l = detail::read_layout(t.get(), file, log);
  if (!wanted(l))
    throw UsageError(file.string() + ": has " + std::to_string(l.bits) + " bit " + (is_float(l) ? "float" : "integer") + " samples; " + wanted_name +
                     " wanted");
  detail::check_data_is_there(t.get(), l, file, max_bytes);
  if (l.width > 0x7fffffff || l.height > 0x7fffffff) throw UsageError(file.string() + ": is too large");
  const double dpi = square_dpi(l);
  Raster<T> image(static_cast<int>(l.width), static_cast<int>(l.height), l.channels, dpi > 0 ? kMetresPerInch / dpi : 0);
  detail::decode_samples<T>(t.get(), l, file, log, image.data.data());
  return image;
}
}  // namespace

TiffInfo read_tiff_info(const std::filesystem::path& file) {
  detail::TiffLog log;
  const auto t = detail::open_tiff_reader(file, log);
  const auto l = detail::read_layout(t.get(), file, log);
  TiffInfo info;
  info.width = l.width;
  info.height = l.height;
  info.channels = l.channels;
  info.bits = l.bits;
  info.kind = kind_of(l);
  info.dpi = square_dpi(l);
  info.compression = compression_of(l);
  std::uint32_t rows = 0;
  TIFFGetFieldDefaulted(t.get(), TIFFTAG_ROWSPERSTRIP, &rows);
  info.rows_per_strip = static_cast<int>(std::min<std::int64_t>(rows, l.height));
  if (l.photometric == PHOTOMETRIC_SEPARATED) {
    info.ink_names = ink_names(t.get(), l.channels);
    std::uint16_t none = 0, full = 255;
    if (TIFFGetField(t.get(), TIFFTAG_DOTRANGE, &none, &full)) info.no_ink_value = none > full ? 255 : 0;
  }
  char* text = nullptr;
  if (TIFFGetField(t.get(), TIFFTAG_IMAGEDESCRIPTION, &text) && text) info.description = text;
  if (TIFFGetField(t.get(), TIFFTAG_SOFTWARE, &text) && text) info.software = text;
  info.big_tiff = TIFFIsBigTIFF(t.get()) != 0;
  return info;
}

Raster8 read_tiff8(const std::filesystem::path& file, double max_bytes) {
  return read_all<std::uint8_t>(
      file, max_bytes, [](const detail::TiffLayout& l) { return l.bits == 8 && l.sample_format == SAMPLEFORMAT_UINT; }, "8 bit unsigned");
}
RasterF read_tiff_f32(const std::filesystem::path& file, double max_bytes) { return read_all<float>(file, max_bytes, is_float, "32 bit float"); }
}  // namespace venato::graphics
