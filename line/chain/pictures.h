#pragma once
/// The pictures of a line, cut to the slab and brought to their physical frame.
#include <string>
#include <vector>
#include "base/error.h"
#include "graphics/graphic.h"
#include "line/config/line_config.h"
#include "sync/transform/transform.h"
namespace venato::line {

/// Design picture cut to the slab: design frame (fired size), sRGB or grey as in the file.
graphics::Raster8 load_design(const LineConfig& config);

struct LoadedLayer {
  std::string name;
  bool warp = true;
  graphics::Raster8 picture;  ///< print frame, 3 channels sRGB, the trial placement applied
  graphics::Graphic inks;     ///< separated
};
std::vector<LoadedLayer> load_graphic(const LineConfig& config);
/// All layers (or those that warp only) multiplied: what the print looks like. Print frame, sRGB.
graphics::Raster8 flatten_layers(const std::vector<LoadedLayer>& layers, bool warped_only);

/// Where content drawn at print point p without the trial placement lies with it: rotate about the slab's centre, then move.
sync::Transform placement_transform(const LineConfig& config);

/// Problems that need the pictures themselves: cannot be read, too small for the slab. Pointers as in the config. Decodes the pictures.
std::vector<ConfigIssue> check_pictures(const LineConfig& config);
}  // namespace venato::line
