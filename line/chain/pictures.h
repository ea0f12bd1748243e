#pragma once
/// The pictures of a line, cut to the slab and brought to their physical frame.
#include <string>
#include <vector>
#include "base/error.h"
#include "graphics/graphic.h"
#include "graphics/tiff/ink_picture.h"
#include "line/config/line_config.h"
#include "sync/transform/transform.h"
namespace venato::line {

/// Design picture cut to the slab: design frame (fired size), sRGB or grey as in the file.
graphics::Raster8 load_design(const LineConfig& config);

struct LoadedLayer {
  std::string name;
  bool warp = true;
  graphics::Raster8 picture;  ///< print frame, 3 channels sRGB, the trial placement applied
  graphics::Graphic inks;     ///< separated, or as the file has them
  bool own_inks = false;      ///< the file is a separated TIFF: its ink amounts pass through
};
/// A picture is separated by the printer's profile, or without one by the inks' solids (a preview). A separated TIFF passes through, its channels in
/// the printer's order. Same bytes for any number of threads. \throws UsageError, see graphics/graphic.h, icc/separate_by_profile.h,
/// tiff/ink_picture.h
std::vector<LoadedLayer> load_graphic(const LineConfig& config, int threads);
/// The inks of the printer: of the config, or of the profile. \throws UsageError: the profile cannot be used
struct GraphicInks {
  std::vector<graphics::Ink> inks;
  Rgb8 body_srgb{};
  bool by_profile = false;
};
GraphicInks graphic_inks(const LineConfig& config);
/// For each ink of the printer the channel of a separated TIFF. Names decide (upper and lower case alike); a file without names, or inks of a
/// profile, go by their order. \throws UsageError naming the file and both lists when they do not fit
std::vector<int> ink_channels(const std::filesystem::path& file, const graphics::InkPictureInfo& info, const GraphicInks& inks);
/// All layers (or those that warp only) multiplied: what the print looks like. Print frame, sRGB.
graphics::Raster8 flatten_layers(const std::vector<LoadedLayer>& layers, bool warped_only);

/// Where content drawn at print point p without the trial placement lies with it: rotate about the slab's centre, then move.
sync::Transform placement_transform(const LineConfig& config);

/// Problems that need the pictures themselves: cannot be read, too small for the slab. Pointers as in the config. Decodes the pictures.
std::vector<ConfigIssue> check_pictures(const LineConfig& config);
}  // namespace venato::line
