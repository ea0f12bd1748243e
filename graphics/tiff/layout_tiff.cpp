#include "graphics/tiff/layout.h"

#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
namespace venato::graphics::detail {
namespace {
constexpr double kMaxPixels = 1e11;  // 30 x a 3.2 m slab at 600 dpi
constexpr int kMaxChannels = 64;
// Deflate's best is 1032 : 1, LZW's with 4094 codes under 2800 : 1; JPEG's, CCITT's and LERC's flat pictures stay below this too.
constexpr double kMaxExpansion = 4000;
constexpr double kCentimetresPerInch = 2.54;

std::uint16_t field16(tiff* t, std::uint32_t tag, std::uint16_t fallback) {
  std::uint16_t v = fallback;
  return TIFFGetFieldDefaulted(t, tag, &v) ? v : fallback;
}
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) { throw UsageError(file.string() + ": " + reason); }
}  // namespace

TiffLayout read_layout(tiff* t, const std::filesystem::path& file, const TiffLog& log) {
  if (!log.cut_tag.empty()) refuse(file, "truncated: " + log.cut_tag);
  TiffLayout l;
  std::uint32_t width = 0, height = 0;
  if (!TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &width) || !TIFFGetField(t, TIFFTAG_IMAGELENGTH, &height) || width == 0 || height == 0)
    refuse(file, "TIFF without a picture size: " + log.reason("ImageWidth or ImageLength is missing or 0"));
  l.width = width;
  l.height = height;
  l.channels = field16(t, TIFFTAG_SAMPLESPERPIXEL, 1);
  l.bits = field16(t, TIFFTAG_BITSPERSAMPLE, 1);
  l.sample_format = field16(t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  l.compression = field16(t, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  l.planar = field16(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
  l.tiled = TIFFIsTiled(t) != 0;
  l.ink_set = field16(t, TIFFTAG_INKSET, INKSET_CMYK);
  std::uint16_t photometric = 0;
  l.photometric = TIFFGetField(t, TIFFTAG_PHOTOMETRIC, &photometric) ? photometric : PHOTOMETRIC_MINISBLACK;
  std::uint16_t extra = 0;
  std::uint16_t* kinds = nullptr;
  if (TIFFGetField(t, TIFFTAG_EXTRASAMPLES, &extra, &kinds) && extra > 0) {
    l.extra_samples = extra;
    l.first_extra = kinds[0];
  }
  if (static_cast<double>(width) * height > kMaxPixels)
    refuse(file, "claims " + std::to_string(width) + " x " + std::to_string(height) + " px; more than 1e11 px is refused");
  if (l.channels < 1 || l.channels > kMaxChannels) refuse(file, "has " + std::to_string(l.channels) + " channels; limits 1 to 64");
  float x = 0, y = 0;
  if (TIFFGetField(t, TIFFTAG_XRESOLUTION, &x) && TIFFGetField(t, TIFFTAG_YRESOLUTION, &y) && std::isfinite(x) && std::isfinite(y) && x > 0 &&
      y > 0) {
    const int unit = field16(t, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    const double per_inch = unit == RESUNIT_INCH ? 1 : unit == RESUNIT_CENTIMETER ? kCentimetresPerInch : 0;
    l.dpi_x = x * per_inch;
    l.dpi_y = y * per_inch;
  }
  return l;
}

void check_data_is_there(tiff* t, const TiffLayout& l, const std::filesystem::path& file, double max_bytes) {
  const double needed = static_cast<double>(l.width) * static_cast<double>(l.height) * l.channels * l.bits / 8;
  if (needed > max_bytes)
    refuse(file, "claims " + std::to_string(l.width) + " x " + std::to_string(l.height) + " px x " + std::to_string(l.channels) +
                     " channels = " + std::to_string(static_cast<long long>(needed / 1e6)) + " MB; limit " +
                     std::to_string(static_cast<long long>(max_bytes / 1e6)) + " MB");
  const std::uint64_t file_bytes = std::filesystem::file_size(file);
  // Each strip needs at least one byte of the file, so a count beyond that is a lie and walking it would be slow.
  const std::uint64_t pieces = l.tiled ? TIFFNumberOfTiles(t) : TIFFNumberOfStrips(t);
  if (pieces == 0 || pieces > file_bytes)
    refuse(file, "truncated or corrupt: " + std::to_string(pieces) + " strips in a file of " + std::to_string(file_bytes) + " bytes");
  double stored = 0;
  for (std::uint32_t k = 0; k < pieces; ++k) {
    const std::uint64_t offset = TIFFGetStrileOffset(t, k), count = TIFFGetStrileByteCount(t, k);
    if (offset == 0 || count == 0) refuse(file, "truncated or corrupt: strip " + std::to_string(k) + " has no data");
    if (count > file_bytes || offset > file_bytes - count)
      refuse(file, "truncated: strip " + std::to_string(k) + " should end at byte " + std::to_string(offset + count) + ", the file has " +
                       std::to_string(file_bytes));
    stored += static_cast<double>(count);
  }
  const double expansion = l.compression == COMPRESSION_NONE ? 1 : kMaxExpansion;
  if (needed > stored * expansion) refuse(file, "corrupt: claims more pixels than its data can hold");
}

template <class T>
void decode_samples(tiff* t, const TiffLayout& l, const std::filesystem::path& file, const TiffLog& log, T* out) {
  const auto width = static_cast<std::size_t>(l.width), height = static_cast<std::size_t>(l.height), channels = static_cast<std::size_t>(l.channels);
  const std::size_t plane_channels = l.planar ? 1 : channels;  // samples per pixel in one strip or tile
  const auto corrupt = [&](std::uint32_t piece) {
    refuse(file, std::string("truncated or corrupt: ") + (l.tiled ? "tile " : "strip ") + std::to_string(piece) + ": " + log.reason("too few data"));
  };
  // Copies a decoded block whose rows are `block_width` pixels into place.
  const auto place = [&](const T* block, std::size_t block_width, std::size_t x0, std::size_t y0, std::size_t w, std::size_t h, std::size_t plane) {
    for (std::size_t j = 0; j < h; ++j) {
      const T* in = block + j * block_width * plane_channels;
      T* row = out + ((y0 + j) * width + x0) * channels;
      if (!l.planar)
        std::memcpy(row, in, w * channels * sizeof(T));
      else
        for (std::size_t i = 0; i < w; ++i) row[i * channels + plane] = in[i];
    }
  };
  const std::size_t planes = l.planar ? channels : 1;
  std::vector<T> block;
  if (l.tiled) {
    std::uint32_t tw = 0, th = 0;
    TIFFGetField(t, TIFFTAG_TILEWIDTH, &tw);
    TIFFGetField(t, TIFFTAG_TILELENGTH, &th);
    const tmsize_t bytes = TIFFTileSize(t);
    if (tw == 0 || th == 0 || bytes <= 0 || static_cast<double>(bytes) > 1e9) refuse(file, "corrupt: bad tile size");
    block.resize(static_cast<std::size_t>(bytes) / sizeof(T));
    for (std::size_t plane = 0; plane < planes; ++plane)
      for (std::size_t y = 0; y < height; y += th)
        for (std::size_t x = 0; x < width; x += tw) {
          const auto tile = TIFFComputeTile(t, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, static_cast<std::uint16_t>(plane));
          if (TIFFReadEncodedTile(t, tile, block.data(), bytes) != bytes) corrupt(tile);
          place(block.data(), tw, x, y, std::min<std::size_t>(tw, width - x), std::min<std::size_t>(th, height - y), plane);
        }
    return;
  }
  std::uint32_t rows = 0;
  TIFFGetFieldDefaulted(t, TIFFTAG_ROWSPERSTRIP, &rows);
  if (rows == 0) refuse(file, "corrupt: RowsPerStrip is 0");
  const std::size_t step = std::min<std::size_t>(rows, height);
  for (std::size_t plane = 0; plane < planes; ++plane)
    for (std::size_t y = 0; y < height; y += step) {
      const std::size_t h = std::min(step, height - y);
      const auto bytes = static_cast<tmsize_t>(h * width * plane_channels * sizeof(T));
      const auto strip = TIFFComputeStrip(t, static_cast<std::uint32_t>(y), static_cast<std::uint16_t>(plane));
      T* target = out + y * width * channels;
      if (l.planar) {
        block.resize(h * width);
        target = block.data();
      }
      if (TIFFReadEncodedStrip(t, strip, target, bytes) != bytes) corrupt(strip);
      if (l.planar) place(block.data(), width, 0, y, width, h, plane);
    }
}
template void decode_samples<std::uint8_t>(tiff*, const TiffLayout&, const std::filesystem::path&, const TiffLog&, std::uint8_t*);
template void decode_samples<std::uint16_t>(tiff*, const TiffLayout&, const std::filesystem::path&, const TiffLog&, std::uint16_t*);
template void decode_samples<float>(tiff*, const TiffLayout&, const std::filesystem::path&, const TiffLog&, float*);
}  // namespace venato::graphics::detail
