#include "graphics/picture/picture_header.h"

#include <array>

#include "base/error.h"
#include "base/units.h"
namespace venato::graphics {
namespace {
constexpr std::string_view kPngMagic("\x89PNG\r\n\x1a\n", 8);
constexpr double kCentimetresPerInch = 2.54;

std::uint32_t byte_at(std::string_view b, std::size_t at) { return static_cast<unsigned char>(b[at]); }
std::uint32_t big16(std::string_view b, std::size_t at) { return byte_at(b, at) << 8 | byte_at(b, at + 1); }
std::uint32_t big32(std::string_view b, std::size_t at) { return big16(b, at) << 16 | big16(b, at + 2); }
[[noreturn]] void refuse(const std::string& reason) { throw UsageError(reason); }

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    table[n] = c;
  }
  return table;
}
constexpr auto kCrcTable = make_crc_table();

/// SOF0-SOF15 without DHT (C4), JPG (C8) and DAC (CC).
bool is_frame_header(std::uint32_t marker) { return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc; }

void read_jfif_density(std::string_view segment, PictureHeader& h) {
  if (segment.size() < 12 || segment.substr(0, 5) != std::string_view("JFIF\0", 5)) return;
  const std::uint32_t unit = byte_at(segment, 7), x = big16(segment, 8), y = big16(segment, 10);
  if (unit == 0 || unit > 2 || x == 0 || y == 0) return;  // unit 0: an aspect ratio, not a density
  const double per_inch = unit == 1 ? 1.0 : kCentimetresPerInch;
  h.dpi_x = x * per_inch;
  h.dpi_y = y * per_inch;
}
}  // namespace

std::uint32_t png_crc(std::string_view bytes) {
  std::uint32_t c = 0xffffffffu;
  for (char b : bytes) c = kCrcTable[(c ^ static_cast<unsigned char>(b)) & 0xff] ^ (c >> 8);
  return c ^ 0xffffffffu;
}

std::optional<PictureFormat> picture_format(std::string_view b) {
  if (b.substr(0, 8) == kPngMagic) return PictureFormat::png;
  if (b.substr(0, 3) == std::string_view("\xff\xd8\xff", 3)) return PictureFormat::jpeg;
  const auto head = b.substr(0, 4);
  for (std::string_view magic :
       {std::string_view("II*\0", 4), std::string_view("MM\0*", 4), std::string_view("II+\0", 4), std::string_view("MM\0+", 4)})
    if (head == magic) return PictureFormat::tiff;
  return std::nullopt;
}

PictureHeader read_png_header(std::string_view b) {
  PictureHeader h;
  bool data = false;
  std::size_t at = kPngMagic.size();
  for (bool first = true;; first = false) {
    if (b.size() - at < 12) refuse("truncated PNG: ends without its IEND chunk");
    const std::size_t length = big32(b, at);
    const std::string_view type = b.substr(at + 4, 4);
    if (first && (type != "IHDR" || length != 13)) refuse("not a PNG: does not begin with an IHDR chunk");
    if (length > b.size() - at - 12) refuse("truncated PNG: chunk " + std::string(type) + " goes beyond the end of the file");
    if (png_crc(b.substr(at + 4, 4 + length)) != big32(b, at + 8 + length))
      refuse("corrupt PNG: checksum of chunk " + std::string(type) + " is wrong");
    const std::size_t body = at + 8;
    if (type == "IHDR") {
      h.width = big32(b, body);
      h.height = big32(b, body + 4);
      if (h.width == 0 || h.height == 0 || h.width > 0x7fffffff || h.height > 0x7fffffff) refuse("corrupt PNG: bad size in IHDR");
    } else if (type == "pHYs" && length == 9 && byte_at(b, body + 8) == 1) {  // unit 1: pixels per metre
      h.dpi_x = big32(b, body) * kMetresPerInch;
      h.dpi_y = big32(b, body + 4) * kMetresPerInch;
    } else if (type == "IDAT") {
      data = true;
    } else if (type == "IEND") {
      if (!data) refuse("corrupt PNG: no picture data");
      return h;
    }
    at = body + length + 4;
  }
}

PictureHeader read_jpeg_header(std::string_view b) {
  PictureHeader h;
  bool scan = false;
  std::size_t at = 2;
  for (;;) {
    if (at + 1 >= b.size()) refuse("truncated JPEG: ends without its end-of-image marker");
    if (byte_at(b, at) != 0xff) refuse("corrupt JPEG: marker expected at byte " + std::to_string(at));
    const std::uint32_t marker = byte_at(b, at + 1);
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    if (marker == 0xd9) break;                                   // EOI
    if (marker == 0x01 || (marker >= 0xd0 && marker <= 0xd7)) {  // TEM, RSTn: no body
      at += 2;
      continue;
    }
    if (b.size() - at < 4 || big16(b, at + 2) < 2 || big16(b, at + 2) > b.size() - at - 2)
      refuse("truncated JPEG: a segment goes beyond the end of the file");
    const std::string_view segment = b.substr(at + 4, big16(b, at + 2) - 2);
    if (is_frame_header(marker)) {
      if (segment.size() < 6 || h.width != 0) refuse("corrupt JPEG: bad frame header");
      h.height = big16(segment, 1);
      h.width = big16(segment, 3);
      if (h.width == 0 || h.height == 0) refuse("corrupt JPEG: size 0 in the frame header");
    }
    if (marker == 0xe0) read_jfif_density(segment, h);
    at += 2 + big16(b, at + 2);
    if (marker != 0xda) continue;
    if (h.width == 0) refuse("corrupt JPEG: a scan before the frame header");
    scan = true;  // entropy-coded bytes up to the next marker that is neither a stuffed FF 00 nor a restart
    for (;; ++at) {
      at = b.find('\xff', at);
      if (at == std::string_view::npos || at + 1 >= b.size()) refuse("truncated JPEG: ends without its end-of-image marker");
      const std::uint32_t next = byte_at(b, at + 1);
      if (next != 0 && next != 0xff && !(next >= 0xd0 && next <= 0xd7)) break;
    }
  }
  if (!scan) refuse("corrupt JPEG: no picture data");
  return h;
}
}  // namespace venato::graphics
