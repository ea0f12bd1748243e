#pragma once
/// What PNG and JPEG files say about themselves, read without decoding, so that a hostile or cut file is refused before a decoder
/// allocates anything. The whole file is walked: a decoder would fill the missing part with grey and say nothing.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
namespace venato::graphics {

enum class PictureFormat { png, jpeg, tiff };
/// By the first bytes; empty when it is none of the three.
std::optional<PictureFormat> picture_format(std::string_view bytes);

struct PictureHeader {
  std::int64_t width = 0, height = 0;
  double dpi_x = 0, dpi_y = 0;  ///< 0: not in the file
};
/// \throws UsageError (reason only; the caller adds the path): truncated, chunk checksum wrong, sizes missing or 0.
/// Source: PNG specification (2nd ed.), 5.2-5.3, 11.2.2 IHDR, 11.3.5.3 pHYs.
PictureHeader read_png_header(std::string_view bytes);
/// Source: ITU T.81 annex B (markers), JFIF 1.02 (density).
PictureHeader read_jpeg_header(std::string_view bytes);

/// CRC-32 of PNG chunks (type and data).
std::uint32_t png_crc(std::string_view bytes);
}  // namespace venato::graphics
