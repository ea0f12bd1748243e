#pragma once
#include <filesystem>
#include <optional>
#include "base/context.h"
#include "graphics/plan/vein_plan.h"
#include "sync/registration/registration.h"
#include "sync/score/score.h"
#include "sync/score/zones.h"
namespace venato::sync {

/// `venato sync`: any two pictures of which one should be printed on the other.
struct SyncOptions {
  std::filesystem::path vein_map;  ///< vein_map.tif of a run (float fractions, first channel = body), or a picture of a slab
  std::filesystem::path camera;    ///< camera file (graphics/rectify): vein_map is its picture; empty: vein_map lies in the slab's frame
  std::filesystem::path graphic;   ///< PNG, JPEG or TIFF picture, or an N-ink separated TIFF
  std::optional<double> vein_pitch_m, graphic_pitch_m;  ///< absent: the file's own dpi
  std::filesystem::path out;                            ///< folder
  RegistrationConfig registration;
  graphics::VeinPlanConfig plan;  ///< how veins are found in pictures; its tone is only used with `tone_given`
  bool tone_given = false;        ///< false: the tone (veins darker or lighter than the body) is chosen per picture
  ScoreConfig score;
  ZoneConfig zones;
};

/// Writes score.json, overlay.png and, when the pictures belong together, map.csv (10 mm grid), misfit.png and, for a
/// graphic with colours, visibility.png into `out`; with a camera also rectified.png, its picture in the slab's frame.
/// \return 0; 1 when they do not belong together: success = false with the reason in score.json, no map.csv
/// \throws UsageError: missing or broken file, no pitch (says which option gives it), unwritable folder; WorkError: disk full
int run_sync(const SyncOptions& options, Context& context);
}  // namespace venato::sync
