#include <tiffio.h>

#include "graphics/tiff/handle.h"
namespace venato::graphics::detail {
namespace {
constexpr int kDeflateLevel = 1;  // of zlib, for float samples; 8 bit ones go through libdeflate

std::uint16_t compression_tag(TiffCompression c) {
  switch (c) {
    case TiffCompression::none:
      return COMPRESSION_NONE;
    case TiffCompression::packbits:
      return COMPRESSION_PACKBITS;
    case TiffCompression::lzw:
      return COMPRESSION_LZW;
    case TiffCompression::deflate:
      return COMPRESSION_ADOBE_DEFLATE;
  }
  return COMPRESSION_NONE;
}
std::uint16_t photometric_tag(TiffKind k) {
  switch (k) {
    case TiffKind::rgb:
      return PHOTOMETRIC_RGB;
    case TiffKind::separated:
      return PHOTOMETRIC_SEPARATED;
    case TiffKind::grey:
    case TiffKind::fractions_f32:
      return PHOTOMETRIC_MINISBLACK;
  }
  return PHOTOMETRIC_MINISBLACK;
}
/// libtiff counts four colour channels for separated data whatever InkSet says, and warns unless the rest are extra samples.
int colour_channels(TiffKind k) { return k == TiffKind::rgb ? 3 : k == TiffKind::separated ? 4 : 1; }
}  // namespace

int bytes_per_sample(const TiffInfo& info) { return info.kind == TiffKind::fractions_f32 ? 4 : 1; }

void set_coding_tags(tiff* t, const TiffInfo& info, std::int64_t height) {
  TIFFSetField(t, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(info.width));
  TIFFSetField(t, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(height));
  TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 8 * bytes_per_sample(info));
  TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, info.kind == TiffKind::fractions_f32 ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
  TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, info.channels);
  TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(t, TIFFTAG_PHOTOMETRIC, photometric_tag(info.kind));
  TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, info.rows_per_strip);
  const int extra = info.channels - colour_channels(info.kind);
  if (extra > 0) {
    const std::vector<std::uint16_t> unspecified(static_cast<std::size_t>(extra), EXTRASAMPLE_UNSPECIFIED);
    TIFFSetField(t, TIFFTAG_EXTRASAMPLES, extra, unspecified.data());
  }
  TIFFSetField(t, TIFFTAG_COMPRESSION, compression_tag(info.compression));
  if (info.compression == TiffCompression::deflate) TIFFSetField(t, TIFFTAG_ZIPQUALITY, kDeflateLevel);
  if (info.compression == TiffCompression::deflate || info.compression == TiffCompression::lzw)
    TIFFSetField(t, TIFFTAG_PREDICTOR, info.kind == TiffKind::fractions_f32 ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
}

void set_description_tags(tiff* t, const TiffInfo& info) {
  TIFFSetField(t, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  if (info.dpi > 0) {
    TIFFSetField(t, TIFFTAG_XRESOLUTION, info.dpi);
    TIFFSetField(t, TIFFTAG_YRESOLUTION, info.dpi);
    TIFFSetField(t, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
  }
  TIFFSetField(t, TIFFTAG_SOFTWARE, info.software.empty() ? "venato" : info.software.c_str());
  if (!info.description.empty()) TIFFSetField(t, TIFFTAG_IMAGEDESCRIPTION, info.description.c_str());
  if (!info.icc_profile.empty()) TIFFSetField(t, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(info.icc_profile.size()), info.icc_profile.data());
  if (info.kind != TiffKind::separated) return;
  std::string names;  // each followed by NUL, as the tag wants it
  for (const auto& n : info.ink_names) names.append(n).push_back('\0');
  TIFFSetField(t, TIFFTAG_INKSET, INKSET_MULTIINK);
  TIFFSetField(t, TIFFTAG_INKNAMES, static_cast<int>(names.size()), names.data());
  TIFFSetField(t, TIFFTAG_NUMBEROFINKS, info.channels);
  const int none = info.no_ink_value;
  TIFFSetField(t, TIFFTAG_DOTRANGE, none, 255 - none);
}
}  // namespace venato::graphics::detail
