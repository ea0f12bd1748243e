#pragma once
/// What every stage's descriptor() would otherwise write again: bind a config, read from its keys, into the closures of a Stage.
#include <memory>
#include <string>
#include "line/stages/stage_api.h"
namespace venato::line {

template <class Config>
struct StageParts {
  std::string name;
  void (*read)(ObjectReader&, Config&);
  dem::CaseCost (*cost)(const Config&, const LineBasics&, int threads);
  Operator (*characterise)(const Config&, const LineBasics&, const std::filesystem::path&, Context&);
  StageOutput (*apply)(const Config&, const Operator&, const ChainState&, const LineBasics&, Context&, int replicate);
  FeedCommands (*plan_commands)(const Config&, const graphics::VeinPlan&, const LineBasics&) = nullptr;  ///< stages that can start a chain
};

template <class Config>
std::function<Stage(ObjectReader&)> stage_reader(const StageParts<Config>& parts) {
  return [parts](ObjectReader& r) {
    auto c = std::make_shared<Config>();
    parts.read(r, *c);
    Stage s;
    s.name = parts.name;
    s.cost = [c, parts](const LineBasics& basics, int threads) { return parts.cost(*c, basics, threads); };
    s.characterise = [c, parts](const LineBasics& basics, const std::filesystem::path& folder, Context& context) {
      return parts.characterise(*c, basics, folder, context);
    };
    s.apply = [c, parts](const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) {
      return parts.apply(*c, op, in, basics, context, replicate);
    };
    if (parts.plan_commands)
      s.plan_commands = [c, parts](const graphics::VeinPlan& plan, const LineBasics& basics) { return parts.plan_commands(*c, plan, basics); };
    return s;
  };
}

/// KPIs of how far the line's set-up is from the measured delay, and of the operator's figures named.
inline void add_delay_kpi(StageOutput& out, const Operator& op, double nominal_delay_s, double belt_speed_m_s) {
  out.kpi["residual_delay_s"] = op.reference_delay_s - nominal_delay_s;
  out.kpi["residual_shift_m"] = (nominal_delay_s - op.reference_delay_s) * belt_speed_m_s;  // late powder lies upstream: negative
}
inline void add_figures_as_kpi(StageOutput& out, const Operator& op, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const auto it = op.figures.find(name); it != op.figures.end()) out.kpi[name] = it->second;
}
}  // namespace venato::line
