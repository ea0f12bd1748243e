#pragma once
/// A small valid line config and stages that do nothing but keep the books, for tests of the chain's own work.
#include <filesystem>
#include <string>
#include <vector>
#include "line/chain/run_chain.h"
#include "line/commands/deposit_head.h"
#include "line/commands/plan_head.h"
#include "line/press_map/press_map.h"
namespace venato::line::fake {

inline std::string config_text(const std::string& chain = R"([{"stage":"dose"},{"stage":"squeeze"}])") {
  const std::string image = std::string(VENATO_SOURCE_DIR) + "/configs/images/pov_calacatta_1600x3200.jpg";
  const std::string powder =
      R"("scale_um":375,"shape":2.75,"lower_cut_um":125,"upper_cut_um":700,"granule_density_kg_m3":1850,"poured_bulk_density_kg_m3":1050)";
  const std::string pair = R"({"restitution":0.44,"sliding_friction":0.5,"rolling_friction":0.1})";
  return R"({"format":"venato-line","version":1,"seed":7,"belt_speed_m_s":0.1,
"slab":{"fired_width_mm":100,"fired_length_mm":200,"fired_thickness_mm":12},
"powders":[{"name":"white","role":"body","colour":"#ffffff",)" +
         powder + R"(},{"name":"grey","role":"vein","colour":"#606060",)" + powder + R"(}],
"materials":{"grain":{"young_modulus_mpa":5},"steel":{"young_modulus_mpa":50},"belt":{"young_modulus_mpa":5},"grain_grain":)" +
         pair + R"(,"grain_steel":)" + pair + R"(,"grain_belt":)" + pair + R"(},
"design":{"image":")" +
         image + R"(","pitch_mm":1,"origin_x_mm":300,"origin_y_mm":700},
"graphic":{"image":")" +
         image +
         R"(","pitch_mm":1,"origin_x_mm":300,"origin_y_mm":700,"inks":[{"name":"black","solid":"#202020"}],"body_colour":"#f0f0f0","print_dpi":50},
"chain":)" +
         chain + "}";
}

/// dose: lays the heads' mass where they say; spill: the same with a share of the mass lost; squeeze: the closed-form press map.
inline StageDescriptor dose(double lost = 0) {
  StageDescriptor d;
  d.name = lost > 0 ? "spill" : "dose";
  d.consumes = {ProductKind::commands};
  d.produces = ProductKind::full_bed;
  d.code_version = "1";
  d.read = [lost](ObjectReader& r) {
    double speed = 0;
    r.number("speed_m_s", speed, {0, 10, "m/s"}, {"test key", 1.0});
    Stage s;
    s.cost = [](const LineBasics&, int) { return dem::CaseCost{1000, 2000, 2e6, 1e6, 3}; };
    s.characterise = [speed](const LineBasics& b, const std::filesystem::path&, Context&) {
      auto op = identity_operator(b.grid.nz);
      op.figures["speed_m_s"] = speed;
      return op;
    };
    s.apply = [lost](const Operator&, const ChainState& in, const LineBasics& b, Context&, int) {
      StageOutput out;
      out.state = in;
      Bed bed = make_bed(b.grid, {b.powders[0].name, b.powders[1].name});
      for (const auto& h : in.commands.heads) deposit_head(h, bed), out.mass_in_kg += h.mass_kg();
      for (auto& m : bed.mass)
        for (auto& v : m) v *= 1 - lost;
      out.mass_out_kg = bed.total_mass_kg();
      out.state.bed = std::move(bed);
      return out;
    };
    s.plan_commands = [](const graphics::VeinPlan& plan, const LineBasics& b) {
      const auto layout = strip_layout(b, "vein_grey", "grey", 0.005, fit_tick(b, 0.02), b.bed_mass_kg_m2);
      FeedCommands c;
      c.heads.push_back(plan_head(plan, b.vein_powder, b, layout, {}));
      c.heads.push_back(complement_head({c.heads[0]}, "body_white", "white", b.bed_mass_kg_m2));
      return c;
    };
    return s;
  };
  return d;
}

inline StageDescriptor squeeze() {
  StageDescriptor d;
  d.name = "squeeze";
  d.consumes = {ProductKind::full_bed};
  d.produces = ProductKind::slab;
  d.code_version = "1";
  d.read = [](ObjectReader&) {
    Stage s;
    s.cost = [](const LineBasics&, int) { return dem::CaseCost{10, 20, 200, 1e6, 1}; };
    s.characterise = [](const LineBasics& b, const std::filesystem::path&, Context&) { return identity_operator(b.grid.nz); };
    s.apply = [](const Operator&, const ChainState& in, const LineBasics& b, Context& context, int) {
      StageOutput out;
      out.state.commands = in.commands;
      out.mass_in_kg = out.mass_out_kg = in.bed->total_mass_kg();
      PressMapConfig press;  // the real press map, as even as it gets
      press.peak_pressure_pa = 40e6, press.density_a_kg_m3 = 1442, press.density_b_kg_m3 = 136, press.lateral_length_factor = 0,
      press.springback = b.nominal_springback;
      const double expand = 1 + b.nominal_springback;
      const CutWindow cut{b.trim_m * expand + b.cut_offset_x_m, b.grid.lead_m * expand + b.cut_offset_y_m, b.cut_rotation_rad,
                          b.fired_width_m * b.green_from_design(), b.fired_length_m * b.green_from_design()};
      out.state.slab = make_slab(*in.bed, compute_press_map(in.bed->areal_mass(), b.grid, press), cut, b.grid.pitch_m, context.threads);
      return out;
    };
    return s;
  };
  return d;
}

inline std::vector<StageDescriptor> stages() { return {dose(), dose(0.01), squeeze()}; }
}  // namespace venato::line::fake
