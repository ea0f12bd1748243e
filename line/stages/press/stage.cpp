#include "line/stages/press/stage.h"

#include <algorithm>
#include <cmath>

#include "line/press_map/press_map.h"
#include "line/stages/make_stage.h"
#include "line/stages/press/slice.h"

namespace venato::line::press {
namespace {

PressMapConfig map_config(const Config& c) {
  PressMapConfig m;
  m.peak_pressure_pa = c.peak_pressure_pa;
  m.density_a_kg_m3 = c.density_a_kg_m3;
  m.density_b_kg_m3 = c.density_b_kg_m3;
  m.lateral_length_factor = c.lateral_length_factor;
  m.springback = c.springback;
  m.edge_gain_m = c.edge_gain_m;
  m.edge_zone_m = c.edge_zone_m;
  m.sigma_nonaffine_m = 0;  // the operator has already blurred the bed by it
  return m;
}

/// The saw stands where the strip was planned to lie, plus the configured error of the cut.
CutWindow cut_window(const LineBasics& basics) {
  const double nominal = 1 + basics.nominal_springback;
  CutWindow cut;
  cut.x_m = basics.trim_m * nominal + basics.cut_offset_x_m;
  cut.y_m = basics.grid.lead_m * nominal + basics.cut_offset_y_m;
  cut.rotation_rad = basics.cut_rotation_rad;
  cut.width_m = basics.fired_width_m * basics.green_from_design();
  cut.length_m = basics.fired_length_m * basics.green_from_design();
  return cut;
}

struct Spread {
  double mean, cv, low, high;
};
Spread spread_of(const graphics::RasterF& r) {
  double sum = 0, square = 0, low = HUGE_VAL, high = -HUGE_VAL;
  for (const float f : r.data) {
    const auto v = static_cast<double>(f);
    sum += v, square += v * v, low = std::min(low, v), high = std::max(high, v);
  }
  const double n = static_cast<double>(r.data.size()), mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, square / n - mean * mean)) / mean, low, high};
}

StageOutput apply_stage(const Config& c, const Operator& op, const ChainState& in, const LineBasics& basics, Context& context, int replicate) {
  StageOutput out;
  out.state = in;
  out.mass_in_kg = in.bed->total_mass_kg();
  Bed bed = apply(op, *in.bed, basics.belt_speed_m_s, op.reference_delay_s, context.threads, replicate);
  const PressMap map = compute_press_map(bed.areal_mass(), bed.grid, map_config(c));
  double pressed = 0;  // what the map holds: thickness x density x pressed area
  for (std::size_t i = 0; i < map.thickness_m.size(); ++i) pressed += map.thickness_m[i] * map.density_kg_m3[i] * map.area_ratio[i];
  out.mass_out_kg = pressed * bed.grid.pitch_m * bed.grid.pitch_m;
  out.state.bed.reset();
  out.state.slab = make_slab(std::move(bed), map, cut_window(basics), basics.grid.pitch_m, context.threads);

  const Spread thickness = spread_of(out.state.slab->thickness_m), density = spread_of(out.state.slab->density_kg_m3),
               pressure = spread_of(out.state.slab->pressure_pa);
  out.kpi["thickness_mean_m"] = thickness.mean;
  out.kpi["density_mean_kg_m3"] = density.mean;
  out.kpi["density_cv"] = density.cv;
  out.kpi["pressure_mean_pa"] = pressure.mean;
  out.kpi["pressure_low_pa"] = pressure.low;
  out.kpi["pressure_high_pa"] = pressure.high;
  out.kpi["share_below_1_mpa"] = map.share_below_1_mpa;
  add_figures_as_kpi(out, op, {"sigma_nonaffine_m", "lid_pressure_end_pa", "inertial_number"});
  return out;
}

dem::CaseCost cost(const Config& c, const LineBasics& basics, int threads) { return estimate_slice_cost(make_case(c, basics), threads); }
}  // namespace

StageDescriptor descriptor() {
  StageDescriptor d;
  d.name = "press";
  d.help = "compaction, lateral and edge displacement, springback; cut to size";
  d.consumes = {ProductKind::full_bed};
  d.produces = ProductKind::slab;
  d.code_version = "1";
  d.read = stage_reader<Config>({"press", read, cost, characterise, apply_stage});
  return d;
}
}  // namespace venato::line::press
