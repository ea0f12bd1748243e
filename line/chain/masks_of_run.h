#pragma once
#include <filesystem>
#include <optional>
#include <vector>
#include "line/chain/run_line.h"
namespace venato::line {

/// Writes the printer files of a finished run again, into `out` (any folder, also RUN/masks): from run.json (config), run.h5 (registration, vein map,
/// feed commands) and the graphic's own pictures; nothing is simulated. With the run's own dpi and choices: the same bytes as RUN/masks.
/// \param run  folder of `venato run` \param dpi  none = the run's
/// \throws UsageError: not the folder of a finished run, a picture that has changed since; and what sync::write_masks throws.
void write_masks_of_run(const std::filesystem::path& run, const std::filesystem::path& out, std::optional<double> dpi, const MaskChoices& choices,
                        Context& context, const std::vector<StageDescriptor>& stages = all_stages());

// ---- parts ---------------------------------------------------------------------------------------------------------------------
struct RunSource {
  std::filesystem::path config_file;  ///< where the config lay when the run was made
  std::string config_json;            ///< resolved
};
/// From RUN/run.json. \throws UsageError naming the file.
RunSource read_run_source(const std::filesystem::path& run);
/// What write_mask_files needs of a run, from RUN/run.h5, and checks that the graphic is the one of the run. \throws UsageError naming the file.
LineRun read_run_for_masks(const std::filesystem::path& run, const LineConfig& config);
}  // namespace venato::line
