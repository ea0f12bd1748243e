#include "line/stages/powder_feeder/stage.h"

#include <cmath>
#include <memory>

#include "line/commands/deposit_head.h"
#include "line/commands/plan_head.h"
#include "line/stages/powder_feeder/slice.h"

namespace venato::line::powder_feeder {
namespace {

/// A feeder that starts the chain lays every powder itself: one row of actuators per powder.
FeedCommands plan_commands(const Config& c, const graphics::VeinPlan& plan, const LineBasics& basics) {
  const std::string vein = basics.powders[static_cast<std::size_t>(basics.vein_powder)].name, body = basics.powders[static_cast<std::size_t>(basics.body_powder)].name;
  const HeadLayout layout = strip_layout(basics, "feeder_" + vein, vein, c.dosing_pitch_m, fit_tick(basics, c.tick_s), basics.bed_mass_kg_m2);
  CommandRules rules;
  rules.min_on_s = rules.min_off_s = 2 * c.gate_travel_time_s;
  FeedCommands commands;
  commands.heads.push_back(plan_head(plan, basics.vein_powder, basics, layout, rules));
  commands.heads.push_back(complement_head({commands.heads[0]}, "feeder_" + body, body, basics.bed_mass_kg_m2));
  return commands;
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
  for (const char* name : {"target", "mass_flow_unevenness"})
    if (const auto it = op.figures.find(name); it != op.figures.end()) out.kpi[name] = it->second;
  out.kpi["residual_delay_s"] = op.reference_delay_s - c.nominal_delay_s;
  out.kpi["residual_shift_m"] = (op.reference_delay_s - c.nominal_delay_s) * basics.belt_speed_m_s;
  out.state.bed = std::move(bed);
  return out;
}
}  // namespace

StageDescriptor descriptor() {
  StageDescriptor d;
  d.name = "powder_feeder";
  d.help = "hoppers with moving actuators and a common bin that lay the powders as a full bed";
  d.consumes = {ProductKind::partial_bed, ProductKind::commands};
  d.produces = ProductKind::full_bed;
  d.code_version = "1";
  d.read = [](ObjectReader& r) {
    auto c = std::make_shared<Config>();
    read(r, *c);
    Stage s;
    s.name = "powder_feeder";
    s.cost = [c](const LineBasics& basics, int threads) { return estimate_slice_cost(make_case(*c, basics), threads); };
    s.characterise = [c](const LineBasics& basics, const std::filesystem::path& folder, Context& context) { return characterise(*c, basics, folder, context); };
    s.apply = [c](const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) { return apply_stage(*c, op, in, basics, context, replicate); };
    s.plan_commands = [c](const graphics::VeinPlan& plan, const LineBasics& basics) { return plan_commands(*c, plan, basics); };
    return s;
  };
  return d;
}
}  // namespace venato::line::powder_feeder
