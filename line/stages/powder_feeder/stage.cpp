#include "line/stages/powder_feeder/stage.h"

#include <cmath>

#include "line/commands/deposit_head.h"
#include "line/commands/plan_head.h"
#include "line/stages/make_stage.h"
#include "line/stages/powder_feeder/slice.h"

namespace venato::line::powder_feeder {
namespace {

/// A feeder that starts the chain lays every powder itself: one row of actuators per powder.
FeedCommands plan_commands(const Config& c, const graphics::VeinPlan& plan, const LineBasics& basics) {
  return plan_vein_and_body(plan, basics, "feeder_", "feeder_", c.dosing_pitch_m, c.tick_s, 2 * c.gate_travel_time_s);
}

StageOutput apply_stage(const Config& c, const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) {
  StageOutput out;
  out.state = in;
  std::vector<std::string> powders;
  for (const PowderSpec& p : basics.powders) powders.push_back(p.name);
  // What an earlier stage already laid has its own operator behind it; the feeder's acts on what the feeder doses.
  std::vector<bool> laid_before(powders.size(), false);
  if (in.bed)
    for (std::size_t k = 0; k < powders.size(); ++k) laid_before[k] = in.bed->powder_mass_kg(k) > 0;
  Bed dosed = make_bed(basics.grid, powders);
  for (const FeedHead& head : in.commands.heads)
    for (std::size_t k = 0; k < powders.size(); ++k)
      if (head.powder == powders[k] && !laid_before[k]) deposit_head(head, dosed), out.mass_in_kg += head.mass_kg();
  Bed bed = apply(op, dosed, basics.belt_speed_m_s, c.nominal_delay_s, context.threads, replicate);
  if (in.bed) {
    out.mass_in_kg += in.bed->total_mass_kg();
    for (std::size_t k = 0; k < powders.size(); ++k)
      for (std::size_t i = 0; i < bed.mass[k].size(); ++i) bed.mass[k][i] += in.bed->mass[k][i];
  }
  out.mass_out_kg = bed.total_mass_kg();

  const std::vector<double> areal = bed.areal_mass();
  double sum = 0, square = 0;
  for (const double m : areal) sum += m, square += m * m;
  const double n = static_cast<double>(areal.size()), mean = sum / n;
  out.kpi["areal_mass_mean_kg_m2"] = mean;
  out.kpi["areal_mass_cv"] = std::sqrt(std::max(0.0, square / n - mean * mean)) / mean;
  add_figures_as_kpi(out, op, {"target", "mass_flow_unevenness"});
  add_delay_kpi(out, op, c.nominal_delay_s, basics.belt_speed_m_s);
  out.state.bed = std::move(bed);
  return out;
}

dem::CaseCost cost(const Config& c, const LineBasics& basics, int threads) { return estimate_slice_cost(make_case(c, basics), threads); }
}  // namespace

StageDescriptor descriptor() {
  StageDescriptor d;
  d.name = "powder_feeder";
  d.help = "hoppers with moving actuators and a common bin that lay the powders as a full bed";
  d.consumes = {ProductKind::partial_bed, ProductKind::commands};
  d.produces = ProductKind::full_bed;
  d.code_version = "1";
  d.read = stage_reader<Config>({"powder_feeder", read, cost, characterise, apply_stage, plan_commands});
  return d;
}
}  // namespace venato::line::powder_feeder
