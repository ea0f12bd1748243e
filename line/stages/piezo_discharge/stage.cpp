#include "line/stages/piezo_discharge/stage.h"

#include <cmath>
#include <memory>

#include "base/error.h"
#include "line/commands/deposit_head.h"
#include "line/commands/plan_head.h"
#include "line/stages/piezo_discharge/slice.h"

namespace venato::line::piezo_discharge {
namespace {

FeedCommands plan_commands(const Config& c, const graphics::VeinPlan& plan, const LineBasics& basics) {
  const std::string vein = basics.powders[static_cast<std::size_t>(basics.vein_powder)].name, body = basics.powders[static_cast<std::size_t>(basics.body_powder)].name;
  const HeadLayout layout = strip_layout(basics, "vein_" + vein, vein, c.prong_pitch_m, fit_tick(basics, c.tick_s), basics.bed_mass_kg_m2);
  CommandRules rules;
  rules.min_on_s = rules.min_off_s = c.min_on_s;
  FeedCommands commands;
  commands.heads.push_back(plan_head(plan, basics.vein_powder, basics, layout, rules));
  commands.heads.push_back(complement_head({commands.heads[0]}, "body_" + body, body, basics.bed_mass_kg_m2));
  return commands;
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
  out.kpi["residual_delay_s"] = op.reference_delay_s - c.nominal_delay_s;
  out.kpi["residual_shift_m"] = (op.reference_delay_s - c.nominal_delay_s) * basics.belt_speed_m_s;
  return out;
}
}  // namespace

StageDescriptor descriptor() {
  StageDescriptor d;
  d.name = "piezo_discharge";
  d.help = "hopper and piezo-driven prongs that dose the vein powder";
  d.consumes = {ProductKind::commands};
  d.produces = ProductKind::partial_bed;
  d.code_version = "1";
  d.read = [](ObjectReader& r) {
    auto c = std::make_shared<Config>();
    read(r, *c);
    Stage s;
    s.name = "piezo_discharge";
    s.cost = [c](const LineBasics& basics, int threads) {
      const auto train = pulse_train(*c, basics);
      dem::CaseCost cost = estimate_slice_cost(make_case(*c, basics, "piezo_discharge pulses", 1.0, train, train_duration(*c, train)), threads);
      const double scale = 1 + static_cast<double>(c->drive_levels.size()) * (c->settle_s + 0.45) / train_duration(*c, train);
      cost.steps *= scale, cost.particle_steps *= scale, cost.seconds *= scale;
      return cost;
    };
    s.characterise = [c](const LineBasics& basics, const std::filesystem::path& folder, Context& context) { return characterise(*c, basics, folder, context); };
    s.apply = [c](const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) { return apply_stage(*c, op, in, basics, context, replicate); };
    s.plan_commands = [c](const graphics::VeinPlan& plan, const LineBasics& basics) { return plan_commands(*c, plan, basics); };
    return s;
  };
  return d;
}
}  // namespace venato::line::piezo_discharge
