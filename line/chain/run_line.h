#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>
#include "line/chain/sync_step.h"
#include "sync/mask/mask_job.h"
namespace venato::line {

struct Figure {
  std::string file;     ///< relative to the run folder
  std::string section;  ///< of the report: "asked" | "slab" | "sync" | stage name
  std::string title, caption;
};
/// How the graphic got its inks.
struct GraphicUse {
  std::vector<graphics::Ink> inks;
  int layers_of_inks = 0, layers_separated = 0;  ///< separated TIFFs that passed through; pictures that were separated
  std::optional<graphics::ProfileUse> profile;   ///< none: by the inks' solids
  std::string intent;
};
GraphicUse graphic_use(const LineConfig& config, const std::vector<LoadedLayer>& layers);

/// Everything one run made. Big: lives once, in run_line().
struct LineRun {
  graphics::VeinPlan plan;  ///< design frame
  std::vector<StageOperator> operators;
  ChainResult chain;
  JitterField jitter;
  std::vector<double> layer_shift_m;
  graphics::VeinMap vein_map;
  SyncResult sync;
  GraphicUse graphic;
  double top_bottom_offset_m = kUnset;
  std::vector<std::string> warnings;
  std::vector<std::pair<std::string, double>> timing_s;  ///< phase, seconds: run.json only
  std::vector<Figure> figures;
  const Slab& slab() const { return *chain.state.slab; }
};

struct RunOutcome {
  bool registered = false;
  std::string reason;   ///< why not
  std::string summary;  ///< a few lines for the terminal
};
/// The whole line into the folder OUT (run.json, run.h5, score.json, report.html, figures, vein_map.tif, masks). Nothing stands under its final name
/// before all of it is complete. \throws ConfigError, UsageError (OUT), WorkError, Interrupted.
RunOutcome run_line(const LineConfig& config, const std::filesystem::path& out, Context& context);

// ---- parts of the run folder -------------------------------------------------------------------------------------------------
void write_run_h5(const std::filesystem::path& file, const LineConfig& config, const LineRun& run);
void write_run_json(const std::filesystem::path& file, const LineConfig& config, const LineRun& run, const Context& context);
void write_score_json(const std::filesystem::path& file, const LineConfig& config, const SyncResult& sync);
void write_vein_map(const std::filesystem::path& file, const graphics::VeinMap& map, int threads);
/// Of the printer files, what no config key says.
struct MaskChoices {
  graphics::TiffCompression compression = graphics::TiffCompression::deflate;
  sync::Polarity print_polarity = sync::Polarity::zero_is_no_ink, ink_file_polarity = sync::Polarity::zero_is_full_ink;
  bool powders_at_print_resolution = false;
};
/// Needs of the run: vein_map, sync.registration, sync.nominal, chain.state.commands.
void write_mask_files(const std::filesystem::path& folder, const LineConfig& config, const LineRun& run, const std::vector<LoadedLayer>& layers,
                      const MaskChoices& choices, Context& context);
/// Draws figures/ and lists them in run.figures.
void write_figures(const std::filesystem::path& run_folder, const LineConfig& config, LineRun& run, const graphics::Raster8& design,
                   const graphics::Raster8& print_srgb);
std::string run_summary(const LineRun& run);
}  // namespace venato::line
