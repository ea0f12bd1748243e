#include <tiffio.h>

#include "base/error.h"
#include "graphics/picture/flatten.h"
#include "graphics/tiff/layout.h"
#include "graphics/tiff/tiff_picture.h"
namespace venato::graphics {
namespace {
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) { throw UsageError(file.string() + ": " + reason); }

bool plain_samples(const detail::TiffLayout& l) {
  const bool grey = l.photometric == PHOTOMETRIC_MINISBLACK || l.photometric == PHOTOMETRIC_MINISWHITE;
  const bool rgb = l.photometric == PHOTOMETRIC_RGB && l.channels >= 3;
  return (grey || rgb) && (l.bits == 8 || l.bits == 16) && l.sample_format == SAMPLEFORMAT_UINT;
}
template <class T>
Raster8 read_plain(tiff* t, const detail::TiffLayout& l, const std::filesystem::path& file, const detail::TiffLog& log) {
  std::vector<T> samples(static_cast<std::size_t>(l.width) * static_cast<std::size_t>(l.height) * static_cast<std::size_t>(l.channels));
  detail::decode_samples<T>(t, l, file, log, samples.data());
  SampleLayout layout;
  layout.stride = l.channels;
  layout.colours = l.photometric == PHOTOMETRIC_RGB ? 3 : 1;
  layout.white_is_zero = l.photometric == PHOTOMETRIC_MINISWHITE;
  const bool alpha = l.channels > layout.colours && (l.first_extra == EXTRASAMPLE_ASSOCALPHA || l.first_extra == EXTRASAMPLE_UNASSALPHA);
  layout.alpha = !alpha ? Alpha::none : l.first_extra == EXTRASAMPLE_ASSOCALPHA ? Alpha::premultiplied : Alpha::straight;
  return flatten<T>(samples, static_cast<int>(l.width), static_cast<int>(l.height), layout);
}
/// Palettes, bilevel, YCbCr …: libtiff's own conversion to 8 bit RGBA (colours premultiplied by alpha).
Raster8 read_converted(tiff* t, const detail::TiffLayout& l, const std::filesystem::path& file, const detail::TiffLog& log) {
  char why[1024] = "";
  TIFFRGBAImage image;
  if (!TIFFRGBAImageOK(t, why) || !TIFFRGBAImageBegin(&image, t, 1, why)) refuse(file, std::string("unsupported kind of TIFF: ") + why);
  image.req_orientation = image.orientation;
  std::vector<std::uint32_t> rgba(static_cast<std::size_t>(l.width) * static_cast<std::size_t>(l.height));
  const int ok = TIFFRGBAImageGet(&image, rgba.data(), static_cast<std::uint32_t>(l.width), static_cast<std::uint32_t>(l.height));
  TIFFRGBAImageEnd(&image);
  if (!ok || !log.first_error.empty()) refuse(file, "truncated or corrupt: " + log.reason("too few data"));
  Raster8 out(static_cast<int>(l.width), static_cast<int>(l.height), 3, 0);
  for (std::size_t k = 0; k < rgba.size(); ++k) {
    const std::uint32_t p = rgba[k], white = 255 - TIFFGetA(p);
    out.data[3 * k] = static_cast<std::uint8_t>(std::min(255u, TIFFGetR(p) + white));
    out.data[3 * k + 1] = static_cast<std::uint8_t>(std::min(255u, TIFFGetG(p) + white));
    out.data[3 * k + 2] = static_cast<std::uint8_t>(std::min(255u, TIFFGetB(p) + white));
  }
  return out;
}
}  // namespace

TiffPicture read_tiff_picture(const std::filesystem::path& file, double max_pixels) {
  detail::TiffLog log;
  const auto t = detail::open_tiff_reader(file, log);
  const auto l = detail::read_layout(t.get(), file, log);
  const double pixels = static_cast<double>(l.width) * static_cast<double>(l.height);
  if (pixels > max_pixels || l.width > 0x7fffffff || l.height > 0x7fffffff) refuse(file, too_many_pixels(l.width, l.height, max_pixels));
  if (l.photometric == PHOTOMETRIC_SEPARATED)
    refuse(file, "is a separated TIFF of " + std::to_string(l.channels) +
                     " inks, not an RGB or grey picture; give it as ink channels or convert it to RGB");
  if (l.sample_format != SAMPLEFORMAT_UINT && l.sample_format != SAMPLEFORMAT_VOID)
    refuse(file, "has float or signed samples, not 8 or 16 bit unsigned ones");
  detail::check_data_is_there(t.get(), l, file, pixels * l.channels * l.bits);
  TiffPicture picture;
  picture.dpi_x = l.dpi_x;
  picture.dpi_y = l.dpi_y;
  if (!plain_samples(l))
    picture.pixels = read_converted(t.get(), l, file, log);
  else if (l.bits == 8)
    picture.pixels = read_plain<std::uint8_t>(t.get(), l, file, log);
  else
    picture.pixels = read_plain<std::uint16_t>(t.get(), l, file, log);
  return picture;
}
}  // namespace venato::graphics
