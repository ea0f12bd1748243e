#include <algorithm>
#include <cmath>

#include "line/config/line_config.h"
namespace venato::line {
namespace {

/// Moist powder per belt area that makes the fired slab [kg/m2].
/// fired areal mass = thickness * fired density; dry powder = that / (1 - loss on ignition); moist = dry * (1 + moisture, dry basis). The fired area
/// is smaller than the belt area by belt_from_design squared. Check (domain notes 1.2): 12 mm at 2320 kg/m3 needs 25.2 kg/m2 of dry powder per green
/// area.
double bed_mass(const LineBasics& b) {
  const double fired = b.fired_thickness_m * b.fired_density_kg_m3;
  const double moist = fired / (1 - b.loss_on_ignition) * (1 + b.moisture);
  return moist / (b.belt_from_design() * b.belt_from_design());
}

int round_up(double length, double step) { return static_cast<int>(std::ceil(length / step - 1e-9)); }

BedGrid make_grid(const LineBasics& b, double module_m, double pitch_m, double lead_m, int layers) {  // b.trim_m is whole modules already
  BedGrid g;
  g.pitch_m = pitch_m;
  g.nz = layers;
  const double width = round_up(b.fired_width_m * b.belt_from_design() + 2 * b.trim_m, module_m) * module_m;
  g.nx = static_cast<int>(std::lround(width / pitch_m));
  // Lead and strip length are whole modules as well, so that fine and coarse grids cover exactly the same strip.
  g.lead_m = round_up(lead_m, module_m) * module_m;
  const double length = round_up(b.fired_length_m * b.belt_from_design() + 2 * g.lead_m, module_m) * module_m;
  g.ny = static_cast<int>(std::lround(length / pitch_m));
  return g;
}
}  // namespace

double fit_pitch(double width_module_m, double pitch_m) {
  const double parts = std::max(1.0, std::ceil(width_module_m / pitch_m - 1e-9));
  return width_module_m / parts;
}

void derive_basics(LineConfig& c) {
  auto& b = c.basics;
  b.bed_mass_kg_m2 = bed_mass(b);
  b.trim_m = round_up(c.grid_trim_m, c.width_module_m) * c.width_module_m;
  b.grid = make_grid(b, c.width_module_m, c.grid_pitch_m, c.grid_lead_m, b.grid.nz);
  // Walls need some density to be a valid material; nothing is computed from it.
  for (auto& m : b.materials.materials) m.density_kg_m3 = b.powders.front().granule_density_kg_m3;
  b.material_inputs_json = material_inputs_json(b);
}

LineBasics coarse_basics(const LineConfig& c, double pitch_m) {
  LineBasics b = c.basics;
  b.grid = make_grid(b, c.width_module_m, fit_pitch(c.width_module_m, pitch_m), c.grid_lead_m, b.grid.nz);
  return b;
}
}  // namespace venato::line
