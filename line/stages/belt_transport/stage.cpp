#include "line/stages/belt_transport/stage.h"

#include <cmath>

#include "line/stages/belt_transport/slice.h"
#include "line/stages/make_stage.h"

namespace venato::line::belt_transport {
namespace {
StageOutput apply_stage(const Config& c, const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) {
  StageOutput out;
  out.state = in;
  out.mass_in_kg = in.bed->total_mass_kg();
  out.state.bed = apply(op, *in.bed, basics.belt_speed_m_s, c.nominal_delay_s, context.threads, replicate);
  out.mass_out_kg = out.state.bed->total_mass_kg();
  add_figures_as_kpi(
      out, op,
      {"areal_mass_kg_m2", "top_minus_bottom_delay_s", "stationarity_velocity_change", "sinkhorn_correction", "blur_along_m", "blur_across_m"});
  out.kpi["areal_mass_needed_kg_m2"] = basics.bed_mass_kg_m2;
  add_delay_kpi(out, op, c.nominal_delay_s, basics.belt_speed_m_s);
  return out;
}

dem::CaseCost cost(const Config& c, const LineBasics& basics, int threads) { return estimate_slice_cost(make_case(c, basics), threads); }
}  // namespace

StageDescriptor descriptor() {
  StageDescriptor d;
  d.name = "belt_transport";
  d.help = "extraction from the bin by the belt, levelling gate, drop to the next belt";
  d.consumes = {ProductKind::full_bed};
  d.produces = ProductKind::full_bed;
  d.code_version = "1";
  d.read = stage_reader<Config>({"belt_transport", read, cost, characterise, apply_stage});
  return d;
}
}  // namespace venato::line::belt_transport
