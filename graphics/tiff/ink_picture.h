#pragma once
/// A separated TIFF as the graphic itself: ink amounts that no separation touches.
#include <filesystem>
#include <string>
#include <vector>
#include "graphics/raster/raster.h"
namespace venato::graphics {

/// Whether the file begins like a TIFF and says Photometric 5 (separated). false for everything else, unreadable files too.
bool is_separated_tiff(const std::filesystem::path& file);

/// What the header says of the inks.
struct InkPictureInfo {
  std::int64_t width = 0, height = 0;
  int inks = 0;
  double dpi = 0;                  ///< 0: not in the file
  std::vector<std::string> names;  ///< InkNames, one per ink; empty without
};
/// \throws UsageError naming file and reason: not a separated TIFF, samples other than 8 bit, more than max_pixels
InkPictureInfo read_ink_picture_info(const std::filesystem::path& file, double max_pixels = 2.5e8);
/// \return 0 = no ink, 255 = full ink (a file whose DotRange says otherwise is inverted); channels in the file's order; pitch_m 0 without dpi.
/// \throws UsageError as above, and for a truncated or corrupt file
Raster8 read_ink_picture(const std::filesystem::path& file, double max_pixels = 2.5e8);
}  // namespace venato::graphics
