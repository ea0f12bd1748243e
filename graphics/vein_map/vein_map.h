#pragma once
#include <array>
#include <string>
#include <vector>
#include "graphics/raster/raster.h"
namespace venato::graphics {

/// What is seen on the face of the pressed slab (or at a polishing depth, or in a cut), in the green frame.
struct VeinMap {
  std::vector<std::string> powders;                  ///< channel order
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< sRGB of each powder
  RasterF fraction;                                  ///< channels = powders, sum 1
  RasterF std_error;                                 ///< one channel: standard error of the vein fraction (sum of all non-body powders); may be empty
  int body_powder = 0;                               ///< the channel that is not vein
  double depth_m = 0;                                ///< below the pressed face
};

RasterF vein_fraction(const VeinMap& map);   ///< 1 - body fraction, one channel
Raster8 colour_preview(const VeinMap& map);  ///< sRGB, mixed in linear light
}  // namespace venato::graphics
