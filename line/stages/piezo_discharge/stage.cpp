#include "line/stages/piezo_discharge/stage.h"

#include <cmath>

#include "base/error.h"
#include "line/commands/deposit_head.h"
#include "line/commands/plan_head.h"
#include "line/stages/make_stage.h"
#include "line/stages/piezo_discharge/slice.h"

namespace venato::line::piezo_discharge {
namespace {

FeedCommands plan_commands(const Config& c, const graphics::VeinPlan& plan, const LineBasics& basics) {
  return plan_vein_and_body(plan, basics, "vein_", "body_", c.prong_pitch_m, c.tick_s, c.min_on_s);
}

StageOutput apply_stage(const Config& c, const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) {
  StageOutput out;
  out.state = in;
  std::vector<std::string> powders;
  for (const PowderSpec& p : basics.powders) powders.push_back(p.name);
  Bed laid = make_bed(basics.grid, powders);
  const std::string& vein = basics.powders[static_cast<std::size_t>(basics.vein_powder)].name;
  for (const FeedHead& head : in.commands.heads)
    if (head.powder == vein) deposit_head(head, laid), out.mass_in_kg += head.mass_kg();
  out.state.bed = apply(op, laid, basics.belt_speed_m_s, c.nominal_delay_s, context.threads, replicate);
  out.mass_out_kg = out.state.bed->total_mass_kg();

  const double needed = basics.bed_mass_kg_m2 * basics.belt_speed_m_s * c.prong_pitch_m;
  const auto flow = op.figures.find("mass_flow_per_prong_kg_s");
  out.kpi["flow_needed_per_prong_kg_s"] = needed;
  if (flow != op.figures.end()) {
    out.kpi["mass_flow_per_prong_kg_s"] = flow->second;
    out.kpi["rows_needed"] = std::ceil(needed / flow->second);
    out.kpi["rows_in_series"] = c.rows_in_series;
  }
  add_delay_kpi(out, op, c.nominal_delay_s, basics.belt_speed_m_s);
  return out;
}

dem::CaseCost cost(const Config& c, const LineBasics& basics, int threads) {
  const auto train = pulse_train(c, basics);
  const double duration = train_duration(c, train);
  dem::CaseCost all = estimate_slice_cost(make_case(c, basics, "piezo_discharge pulses", 1.0, train, duration), threads);
  const double scale = 1 + static_cast<double>(c.drive_levels.size()) * (c.settle_s + kLevelTime_s) / duration;
  all.steps *= scale, all.particle_steps *= scale, all.seconds *= scale;
  return all;
}
}  // namespace

StageDescriptor descriptor() {
  StageDescriptor d;
  d.name = "piezo_discharge";
  d.help = "hopper and piezo-driven prongs that dose the vein powder";
  d.consumes = {ProductKind::commands};
  d.produces = ProductKind::partial_bed;
  d.code_version = "1";
  d.read = stage_reader<Config>({"piezo_discharge", read, cost, characterise, apply_stage, plan_commands});
  return d;
}
}  // namespace venato::line::piezo_discharge
