#include "graphics/tiff/ink_picture.h"

#include <fstream>

#include "base/error.h"
#include "graphics/picture/flatten.h"
#include "graphics/picture/picture_header.h"
#include "graphics/tiff/tiff_file.h"
namespace venato::graphics {
namespace {
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) { throw UsageError(file.string() + ": " + reason); }

TiffInfo checked_info(const std::filesystem::path& file, double max_pixels) {
  TiffInfo info = read_tiff_info(file);
  if (info.kind != TiffKind::separated) refuse(file, "is not a separated TIFF (Photometric 5)");
  if (info.bits != 8) refuse(file, "has " + std::to_string(info.bits) + " bit inks; 8 bit contone wanted");
  if (static_cast<double>(info.width) * static_cast<double>(info.height) > max_pixels)
    refuse(file, too_many_pixels(info.width, info.height, max_pixels));
  return info;
}
}  // namespace

bool is_separated_tiff(const std::filesystem::path& file) {
  std::string head(8, '\0');
  std::ifstream in(file, std::ios::binary);
  if (!in.read(head.data(), static_cast<std::streamsize>(head.size())) || picture_format(head) != PictureFormat::tiff) return false;
  try {
    return read_tiff_info(file).kind == TiffKind::separated;
  } catch (const UsageError&) {
    return false;  // whoever reads it as a picture says what is wrong with it
  }
}

InkPictureInfo read_ink_picture_info(const std::filesystem::path& file, double max_pixels) {
  const TiffInfo info = checked_info(file, max_pixels);
  InkPictureInfo out{info.width, info.height, info.channels, info.dpi, info.ink_names};
  if (out.names.size() != static_cast<std::size_t>(out.inks)) out.names.clear();
  return out;
}

Raster8 read_ink_picture(const std::filesystem::path& file, double max_pixels) {
  const TiffInfo info = checked_info(file, max_pixels);
  Raster8 ink = read_tiff8(file, max_pixels * info.channels);
  if (info.no_ink_value == 255)
    for (auto& v : ink.data) v = static_cast<std::uint8_t>(255 - v);
  return ink;
}
}  // namespace venato::graphics
