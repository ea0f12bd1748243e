#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>
#include "graphics/graphic.h"
#include "graphics/plan/vein_plan.h"
#include "graphics/raster/raster.h"
#include "graphics/rectify/rectify.h"
#include "sync/registration/registration.h"
namespace venato::sync {

/// One of the two inputs of `venato sync`, at most 1 px per mm fine (area averaged).
struct SyncInput {
  std::filesystem::path file;
  bool is_fraction_map = false;  ///< float fractions of a run
  graphics::RasterF fraction;    ///< vein fraction 0..1: from the map, or planned from the picture
  graphics::Raster8 picture;     ///< sRGB or grey; empty for a fraction map
  graphics::Raster8 valid;       ///< 255 where a camera saw the slab, size of fraction and picture; empty: everywhere. No veins where it did not.
  std::optional<graphics::Rectified> camera;  ///< at the camera file's pitch
  bool has_colours = false;                   ///< the picture's are those of the print; false for fractions and inks (whose picture is their sum)
  double pitch_in_file_m = 0;                 ///< of the file as loaded
  bool pitch_from_file = false;
  graphics::VeinTone tone = graphics::VeinTone::darker;  ///< how the veins of the picture were found
};

/// \param pitch_option  named in the message when the file has no dpi, e.g. "--vein-pitch-mm"
/// \throws UsageError naming file and reason
SyncInput load_input(const std::filesystem::path& file, std::optional<double> pitch_m, const std::string& pitch_option,
                     const graphics::VeinPlanConfig& plan, bool tone_given);
/// A camera's picture of the slab, brought into the slab's frame by its camera file. \throws UsageError: rectify()'s reasons, and for fraction maps
/// and separated TIFFs, which no camera takes
SyncInput load_camera_input(const std::filesystem::path& file, const std::filesystem::path& camera, const graphics::VeinPlanConfig& plan,
                            bool tone_given, int threads);

/// What registration compares.
struct EvidencePair {
  std::string name;  ///< for messages and score.json
  Evidence green, print;
};
/// The pairs to try, best first. A fraction map: against the veins planned from the graphic (what the dosing heads were told), then, should that not
/// register well (the graphic was planned in another way), against the graphic's lightness. A picture of a slab: lightness against lightness.
std::vector<EvidencePair> evidence_pairs(const SyncInput& vein_map, const SyncInput& graphic);

/// L*/100 of a grey or sRGB picture.
graphics::RasterF lightness(const graphics::Raster8& picture);
/// 255 where the fraction is at least one half.
graphics::Raster8 vein_mask(const graphics::RasterF& fraction);
/// Share of (valid) pixels that are vein.
double vein_share(const graphics::RasterF& fraction, const graphics::Raster8& valid = {});
/// Sets what is not valid to 0; an empty `valid` is valid everywhere.
void keep_valid(graphics::Raster8& mask, const graphics::Raster8& valid);
}  // namespace venato::sync
