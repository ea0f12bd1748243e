#pragma once
#include <filesystem>
#include "graphics/raster/raster.h"
namespace venato::graphics {

/// A TIFF as a picture: 1 (grey) or 3 (RGB) channels of 8 bit. 16 bit is reduced, palettes and 1 to 4 bit expanded, alpha composed on white
/// (in sRGB values), the orientation tag ignored. Separated (CMYK, N inks) and float files are refused: they are no pictures.
struct TiffPicture {
  Raster8 pixels;               ///< pitch_m left at 0
  double dpi_x = 0, dpi_y = 0;  ///< 0: not in the file
};
/// \throws UsageError naming file and reason; nothing is decoded before size and data have been checked.
TiffPicture read_tiff_picture(const std::filesystem::path& file, double max_pixels);
}  // namespace venato::graphics
