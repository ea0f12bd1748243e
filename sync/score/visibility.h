#pragma once
/// How much of a misalignment an eye at a distance sees: the same colours laid on the body's veins and on the print's veins, compared by S-CIELAB.
#include <optional>
#include <vector>
#include "graphics/colour/srgb.h"
#include "sync/score/score.h"
namespace venato::sync {

/// Mean colours of the graphic on and beside its veins, averaged in linear light.
struct PrintColours {
  graphics::Srgb8 vein{}, ground{};
  double delta_e = 0;  ///< CIEDE2000 between them: what a misfit wide enough would show at any distance
};
/// \param picture grey or sRGB, any pitch \param vein_fraction 0..1 of the same frame (a pixel >= 0.5 is vein, NaN is neither)
/// \return nothing when there is no vein or no ground: a colour that is not known is not guessed
std::optional<PrintColours> print_colours(const graphics::Raster8& picture, const graphics::RasterF& vein_fraction);

struct VisibilityConfig {
  std::vector<double> distances_m = {0.5, 1, 2};
  /// A just noticeable difference. Source: Mahy, Van Eycken, Oosterlinck, Color Res. Appl. 19 (1994) 105: 2.3 in CIELAB, about 1 in CIEDE2000's best
  /// conditions; visible length takes the larger one: seen without looking for it.
  double noticeable_delta_e = 2.3;
  double resolved_rad = 2.908882e-4;  ///< 1 arcmin, 20/20 sight: 0.29 mm at 1 m. A smaller shift is no misalignment to the eye, whatever its contrast
};

/// What is seen from one distance. NaN where neither mask has a vein.
struct Visibility {
  double distance_m = 0;
  double delta_e_mean = 0, delta_e_p95 = 0;  ///< over the pixels that a body or a print vein covers (the ground in between would only dilute it)
  double area_over_1 = 0, area_over_2 = 0;   ///< 0..1 of the slab whose CIEDE2000 is above 1 and 2
  /// Centre-line length along which a difference above noticeable_delta_e lies across the vein and, where the line has a partner, its distance is
  /// more than the eye resolves. Displaced and extra are of the print; missing is body vein without print.
  double displaced_length_m = 0, extra_length_m = 0, missing_length_m = 0;
  double print_length_m = 0;  ///< that was looked at
  graphics::RasterF delta_e;  ///< the map, one channel, on the masks' grid
  /// Of the print: print without body vein is a line that the eye sees and the body does not have, so it counts.
  double visible_length_m() const { return displaced_length_m + extra_length_m; }
};
/// The picture "as aligned" is the body mask painted with colours.vein on colours.ground, the picture "as is" the print mask painted the same way:
/// all that differs is where (and how wide) the veins are, not how well inks match powders. One answer per print, in it one per distance. \param
/// body, prints 0/255, same size and pitch, green frame \throws UsageError as check_masks(), or for a distance that is not positive Viewed
/// perpendicularly, the slab in the colours of the graphic's file under its own white; the pixel of the masks (1 mm) bounds the detail.
std::vector<std::vector<Visibility>> visibility(const graphics::Raster8& body, const std::vector<const graphics::Raster8*>& prints,
                                                const PrintColours& colours, int threads, const VisibilityConfig& config = {},
                                                const ScoreConfig& score = {});

/// What score.json tells of it.
struct VisibilityReport {
  PrintColours colours;
  double noticeable_delta_e = 0;
  std::vector<Visibility> before, after;  ///< one per distance; after: empty when not registered
};
/// Both prints against the body; of the maps only those of the print as it ends (after, or before without one) are kept.
VisibilityReport visibility_report(const graphics::Raster8& body, const graphics::Raster8& before, const graphics::Raster8* after,
                                   const PrintColours& colours, int threads, const VisibilityConfig& config = {}, const ScoreConfig& score = {});
}  // namespace venato::sync
