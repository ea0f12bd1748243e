#pragma once
/// From a vein plan to what a row of dosing heads is told: used by stages that can start a chain.
#include <string>
#include "graphics/plan/vein_plan.h"
#include "line/products/feed_commands.h"
#include "line/stages/stage_api.h"
namespace venato::line {

/// One row of prongs (or gates) across the belt. Prongs and ticks cover the whole strip: see strip_layout().
struct HeadLayout {
  std::string name, powder;
  int prongs = 0, ticks = 0;
  double prong_pitch_m = 0, tick_s = 0;
  double full_rate_kg_m2 = 0;  ///< areal mass laid at duty 1
};
/// Layout that covers the strip of `basics`. Prongs: bed width / pitch, ticks: strip length / (belt speed * tick).
/// \throws UsageError when the bed is not a whole number of prongs, or the strip not a whole number of ticks within 1e-6 (names the nearest values
/// that fit).
HeadLayout strip_layout(const LineBasics& basics, std::string name, std::string powder, double prong_pitch_m, double tick_s, double full_rate_kg_m2);
/// The tick not longer than `tick_s` that divides the strip into whole ticks [s].
double fit_tick(const LineBasics& basics, double tick_s);

enum class DutyMode { on_off, proportional };
struct CommandRules {
  DutyMode mode = DutyMode::on_off;
  double on_threshold = 0.5;  ///< on_off: on where the planned fraction in the cell is above this
  double min_on_s = 0,
         min_off_s = 0;  ///< shortest on and off phases a prong can follow; shorter gaps are closed first, then shorter pulses are lengthened
};

/// Average of the plan over each prong x tick cell (belt frame, exact area weights), then on/off. The plan covers the design only: its
/// outermost pixels are continued over the trim (across) and as far beyond both ends (along), so that a slab cut a little off still has its veins;
/// the rest of lead-in and lead-out is body. \param channel powder of the plan that this head lays.
FeedHead plan_head(const graphics::VeinPlan& plan, int channel, const LineBasics& basics, const HeadLayout& layout, const CommandRules& rules);

/// The head that fills what `heads` leave: duty = 1 - sum of their duties x rates / its own rate, so that every cell of the strip gets the same mass.
/// \throws UsageError when the others lay more than `full_rate_kg_m2` anywhere (names the cell), or when their layouts differ.
FeedHead complement_head(const std::vector<FeedHead>& heads, std::string name, std::string powder, double full_rate_kg_m2);

/// Both heads of a two-powder line on one layout: the vein head on/off by the plan, the body head as its complement. Named prefix + powder.
/// \param min_on_s shortest on and off time
FeedCommands plan_vein_and_body(const graphics::VeinPlan& plan, const LineBasics& basics, const std::string& vein_prefix, const std::string& body_prefix,
                                double prong_pitch_m, double tick_s, double min_on_s);

/// Planned fraction of `channel` averaged over every cell: [tick][prong]. What plan_head thresholds.
std::vector<double> cell_fractions(const graphics::VeinPlan& plan, int channel, const LineBasics& basics, const HeadLayout& layout);
/// Closes off phases shorter than `min_off` ticks, then lengthens on phases shorter than `min_on` ticks around their middle. In place, cyclic strip;
/// column = one prong's on/off.
void enforce_min_times(std::vector<double>& column, int min_on_ticks, int min_off_ticks);
}  // namespace venato::line
