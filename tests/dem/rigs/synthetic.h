#pragma once
/// Made-up results with known answers for the rigs' measuring code.
#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "dem/rigs/rig_api.h"
namespace venato::dem::synthetic {

inline const Kpi& kpi(const std::vector<Kpi>& kpis, const std::string& name) {
  for (const Kpi& k : kpis)
    if (k.name == name) return k;
  throw std::runtime_error("no kpi " + name);
}
inline GrainRecord grain_at(const Vec3& position, double diameter_m) {
  GrainRecord g;
  g.position_m = position;
  g.diameter_m = diameter_m;
  return g;
}
/// One powder of equal grains of density 2000 kg/m^3.
inline Case mono_case(double diameter_m) {
  Case c;
  c.name = "synthetic";
  c.box = {Vec3::Constant(-1), Vec3::Constant(1), {false, false, false}};
  c.materials = {{{"grain", 2000, 1e7, 0.25}}, {{0.5, 0.5, 0.1, 0.3}}};
  c.powders = {{"white", {diameter_m, 3, diameter_m, diameter_m}, 0}};
  c.duration_s = 1;
  return c;
}
}  // namespace venato::dem::synthetic
