#pragma once
/// One line as the user describes it (configs/*.json, format "venato-line" version 1). Const after reading.
#include <filesystem>
#include <limits>
#include <string>
#include <vector>
#include "base/config/object_reader.h"
#include "graphics/graphic.h"
#include "graphics/icc/separate_by_profile.h"
#include "graphics/plan/vein_plan.h"
#include "line/stages/stage_api.h"
#include "sync/registration/registration.h"
#include "sync/score/score.h"
#include "sync/score/zones.h"
namespace venato::line {

inline constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

/// Picture the dosing heads follow. Lengths at fired size.
struct DesignConfig {
  std::filesystem::path image;
  double pitch_m = kUnset;                ///< size of one pixel on the fired slab
  double origin_x_m = 0, origin_y_m = 0;  ///< first corner of the slab inside the picture
  graphics::VeinPlanConfig plan;
};

/// One picture of the inkjet graphic. Layers are multiplied in order; a layer with warp = false keeps its place on the print when the rest is moved
/// onto the veins.
struct GraphicLayer {
  std::filesystem::path image;
  bool warp = true;
};
struct GraphicConfig {
  std::vector<GraphicLayer> layers;  ///< at least one; a plain "image" is one warped layer
  bool single_image = false;         ///< given as `image`, not as `layers`
  double pitch_m = kUnset;           ///< fired size of one pixel
  double origin_x_m = 0, origin_y_m = 0;
  std::vector<graphics::Ink> inks;  ///< in the printer's order; empty with a profile
  Rgb8 body_colour{};               ///< with inks
  std::filesystem::path profile;    ///< ICC output profile of the printer; empty = the inks' solids are used
  graphics::RenderingIntent profile_intent = graphics::RenderingIntent::perceptual;
  double print_dpi = kUnset;     ///< of masks/print.tif
  double total_ink_limit = 2.4;  ///< sum of ink fractions
  /// A known extra move of the graphic on the print, for trials: content lies at rotate(p - centre) + centre + (dx, dy), print frame.
  double placement_dx_m = 0, placement_dy_m = 0, placement_rotation_rad = 0;
};

/// Slow random stretch of the belt between dosing and press (encoder and slip errors): y displacement with this rms and correlation length.
struct BeltJitter {
  double amplitude_m = 0, correlation_m = 0.4;
};
struct VeinMapConfig {
  double polish_depth_m = 0;      ///< below the pressed face
  double coarse_pitch_m = 0.005;  ///< of the bed in the bootstrap replicates
};
struct SyncConfig {
  sync::RegistrationConfig registration;
  sync::ScoreConfig score;
  sync::ZoneConfig zones;
  double threshold = 0.5;  ///< a pixel belongs to a vein when its vein fraction is above
};
struct MasksConfig {
  double preview_pitch_m = 0.001;
  double feather_m = 0.02;
};

struct ConfiguredStage {
  const StageDescriptor* descriptor = nullptr;
  Stage stage;
  std::string pointer;      ///< "/chain/2"
  std::string inputs_json;  ///< canonical subtree of this stage
};

struct LineConfig {
  std::filesystem::path file;
  std::string title;
  LineBasics basics;
  double width_module_m = kUnset, grid_pitch_m = kUnset, grid_lead_m = kUnset, grid_trim_m = kUnset;
  DesignConfig design;
  GraphicConfig graphic;
  std::vector<ConfiguredStage> chain;
  std::size_t chain_entries = 0;  ///< in the file; more than chain.size() when a stage is unknown
  BeltJitter belt_jitter;
  VeinMapConfig vein_map;
  SyncConfig sync;
  MasksConfig masks;
  std::string resolved_json;
  std::vector<PlaceholderUse> placeholders;
};

/// Declares and reads every key of a line config. `stages`: what chain entries may be.
void read_line_config(ObjectReader& r, LineConfig& config, const std::vector<StageDescriptor>& stages);
ReadRoot line_config_root(const std::vector<StageDescriptor>& stages);  ///< for describe-config and the schema

/// Reads, checks everything that can be checked without pictures (ranges, cross-field, order of the chain) and derives basics.
/// \throws UsageError (file cannot be read), ConfigError (all mistakes at once).
LineConfig load_line_config(const std::filesystem::path& file, const std::vector<Override>& overrides,
                            const std::vector<StageDescriptor>& stages = all_stages());
/// Same from text; relative paths are relative to `folder`.
LineConfig load_line_config_text(std::string_view json, const std::filesystem::path& folder, const std::vector<Override>& overrides,
                                 const std::vector<StageDescriptor>& stages);

/// Everything of the basics that follows from the slab: bed mass per belt area, grid sizes. See basics.cpp for the formulas.
void derive_basics(LineConfig& config);
/// Basics on a coarser grid of the same strip (bootstrap replicates, probes): pitch is the coarsest divisor of the width module not above `pitch_m`.
LineBasics coarse_basics(const LineConfig& config, double pitch_m);
double fit_pitch(double width_module_m, double pitch_m);

/// Canonical JSON of what every operator depends on besides its own stage section: powders, materials, belt speed, bed mass, layers, seed …
std::string operator_inputs_json(const LineBasics& basics);
std::string material_inputs_json(const LineBasics& basics);
/// SHA-256 of every file named in a stage section (meshes …), so that a changed file is another operator. "" when there is none.
std::string file_hashes_json(const std::string& stage_inputs_json, const std::filesystem::path& folder);
}  // namespace venato::line
