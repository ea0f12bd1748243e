#include "line/stages/belt_transport/stage.h"

#include <cmath>
#include <memory>

#include "line/stages/belt_transport/slice.h"

namespace venato::line::belt_transport {
namespace {
StageOutput apply_stage(const Config& c, const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) {
  StageOutput out;
  out.state = in;
  out.mass_in_kg = in.bed->total_mass_kg();
  out.state.bed = apply(op, *in.bed, basics.belt_speed_m_s, c.nominal_delay_s, context.threads, replicate);
  out.mass_out_kg = out.state.bed->total_mass_kg();
  for (const char* name : {"areal_mass_kg_m2", "top_minus_bottom_delay_s", "stationarity_velocity_change", "sinkhorn_correction", "blur_along_m", "blur_across_m"})
    if (const auto it = op.figures.find(name); it != op.figures.end()) out.kpi[name] = it->second;
  out.kpi["areal_mass_needed_kg_m2"] = basics.bed_mass_kg_m2;
  out.kpi["residual_delay_s"] = op.reference_delay_s - c.nominal_delay_s;
  out.kpi["residual_shift_m"] = (op.reference_delay_s - c.nominal_delay_s) * basics.belt_speed_m_s;
  return out;
}
}  // namespace

StageDescriptor descriptor() {
  StageDescriptor d;
  d.name = "belt_transport";
  d.help = "extraction from the bin by the belt, levelling gate, drop to the next belt";
  d.consumes = {ProductKind::full_bed};
  d.produces = ProductKind::full_bed;
  d.code_version = "1";
  d.read = [](ObjectReader& r) {
    auto c = std::make_shared<Config>();
    read(r, *c);
    Stage s;
    s.name = "belt_transport";
    s.cost = [c](const LineBasics& basics, int threads) { return estimate_slice_cost(make_case(*c, basics), threads); };
    s.characterise = [c](const LineBasics& basics, const std::filesystem::path& folder, Context& context) { return characterise(*c, basics, folder, context); };
    s.apply = [c](const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) { return apply_stage(*c, op, in, basics, context, replicate); };
    return s;
  };
  return d;
}
}  // namespace venato::line::belt_transport
