#pragma once
/// What a stage is to the chain. A stage is a folder line/stages/<name>/ with stage.h that defines
///   namespace venato::line::<name> { StageDescriptor descriptor(); }
/// The build finds the folder (CMake venato_collect) and lists it; nothing else is edited to add one.
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>
#include "base/config/object_reader.h"
#include "base/context.h"
#include "dem/material.h"
#include "dem/psd/size_distribution.h"
#include "dem/run_case.h"
#include "graphics/plan/vein_plan.h"
#include "line/products/bed.h"
#include "line/products/feed_commands.h"
#include "line/products/operator.h"
#include "line/products/slab.h"

namespace venato::line {

struct PowderSpec {
  std::string name;
  Rgb8 colour{};  ///< sRGB of the fired powder
  dem::SizeDistribution psd;
  double granule_density_kg_m3 = 0, poured_bulk_density_kg_m3 = 0;
};

/// Everything about the line that more than one stage needs. Const after reading.
struct LineBasics {
  double fired_width_m = 0, fired_length_m = 0, fired_thickness_m = 0;
  double firing_shrinkage = 0, drying_shrinkage = 0;  ///< linear, fraction
  double nominal_springback = 0;                      ///< what the line's set-up assumes when it sizes the deposit
  double fired_density_kg_m3 = 0, loss_on_ignition = 0, moisture = 0;
  double belt_speed_m_s = 0;
  std::vector<PowderSpec> powders;
  int body_powder = 0, vein_powder = 1;
  /// DEM materials, fixed order: grain (all powders alike), steel (hoppers, gates, prongs), belt.
  dem::MaterialTable materials;
  static constexpr int kGrain = 0, kSteel = 1, kBelt = 2;
  double bed_mass_kg_m2 = 0;  ///< moist powder per belt area that the slab needs
  BedGrid grid;
  std::uint64_t seed = 0;
  int bootstrap_replicates = 16;
  std::string material_inputs_json;  ///< canonical JSON of powders and materials: part of every operator's key

  /// The slab cut from the pressed strip: its first corner lies at this offset from the nominal corner, turned by this angle about it (green frame).
  double cut_offset_x_m = 0, cut_offset_y_m = 0, cut_rotation_rad = 0;

  /// Strip that is cut away on each side: the design lies at x in [trim, trim + width) of the belt.
  double trim_m = 0;

  /// Linear scales between frames. fired = design size; print = dried (the printer sees the dried slab, the kiln comes after); green = pressed,
  /// before drying; belt = loose powder, before springback.
  double print_from_design() const { return 1.0 / (1 - firing_shrinkage); }
  double green_from_design() const { return print_from_design() / (1 - drying_shrinkage); }
  double belt_from_design() const { return green_from_design() / (1 + nominal_springback); }
};

enum class ProductKind { commands, partial_bed, full_bed, slab };
std::string_view to_string(ProductKind kind);

/// What flows along the chain. The commands stay available to later stages (the feeder needs the body heads).
struct ChainState {
  FeedCommands commands;
  std::optional<Bed> bed;
  std::optional<Slab> slab;
};
struct StageOutput {
  ChainState state;
  double mass_in_kg = 0, mass_out_kg = 0;  ///< must agree to 1e-6 relative: the chain checks
  std::map<std::string, double> kpi;       ///< SI, key ends in unit
};

/// A configured stage: its closures hold its own config by value.
struct Stage {
  std::string name;
  std::function<dem::CaseCost(const LineBasics&, int threads)> cost;
  /// DEM of a periodic slice -> operator, minutes. `checkpoint_folder`: where interrupted DEM leaves its state (one file per case, any names).
  std::function<Operator(const LineBasics&, const std::filesystem::path& checkpoint_folder, Context&)> characterise;
  /// Whole slab, seconds. `replicate` -1 = best estimate, else bootstrap replicate of the operator.
  std::function<StageOutput(const Operator&, const ChainState&, const LineBasics&, Context&, int replicate)> apply;
  /// Stages that can start a chain: what the dosing heads are told for a plan. Null for others.
  std::function<FeedCommands(const graphics::VeinPlan&, const LineBasics&)> plan_commands;
};
struct StageDescriptor {
  std::string_view name, help;
  std::vector<ProductKind> consumes;  ///< any of these
  ProductKind produces;
  std::string_view code_version;             ///< part of the operator's key: raise it when characterise changes its results
  std::function<Stage(ObjectReader&)> read;  ///< declares and reads the stage's keys
};
/// All stages found by the build, sorted by name.
const std::vector<StageDescriptor>& all_stages();
}  // namespace venato::line
