#include <cmath>
#include "line/config/sections.h"
namespace venato::line {
namespace {

constexpr int kMaterials = 3;  // grain, steel, belt: the fixed order of LineBasics

void read_material(ObjectReader& r, dem::Material& m, bool grain) {
  // Softened for the time step (seed paper): flow below the jamming density does not depend on E as long as overlaps stay small; the engine reports
  // them.
  r.number("young_modulus_mpa", m.young_modulus_pa, {0.1, 1e6, "MPa", "0.1 is already too soft to flow like powder"},
           {grain ? "Young modulus of a granule, softened for the time step" : "Young modulus of the wall, softened for the time step", {}, true});
  r.number("poisson_ratio", m.poisson_ratio, {0, 0.49, "1"}, {"Poisson ratio", 0.25, true});
}

void read_pair(ObjectReader& r, dem::PairProperties& p) {
  r.number("restitution", p.restitution, {0.01, 1, "1"},
           {"measured coefficient of restitution (0.44: wet-made granules on glass, nearest published)", {}, true});
  r.number("sliding_friction", p.sliding_friction, {0, 2, "1"}, {"sliding friction coefficient", {}, true});
  r.number("rolling_friction", p.rolling_friction, {0, 1, "1"}, {"rolling friction coefficient of the EPSD law", {}, true});
  r.number("rolling_damping_ratio", p.rolling_damping_ratio, {0, 1, "1"}, {"rolling damping ratio of the EPSD law", 0.3, true});
}

void read_powder(ObjectReader& r, PowderSpec& p, bool& body) {
  r.name("name", p.name, {"used in file names (masks/powder_<name>.tif)"});
  r.choice("role", body, {{"body", true}, {"vein", false}}, {"body fills the slab, vein is dosed by the prongs"});
  r.colour("colour", p.colour, {"sRGB of the fired powder"});
  r.number("scale_um", p.psd.scale_m, {20, 2000, "um"}, {"Weibull scale of the grain diameter, by mass"});
  r.number("shape", p.psd.shape, {0.5, 20, "1"}, {"Weibull shape"});
  r.number("lower_cut_um", p.psd.lower_cut_m, {1, 2000, "um"}, {"smallest grain; the number density diverges at 0 for shape <= 3"});
  r.number("upper_cut_um", p.psd.upper_cut_m, {1, 5000, "um"}, {"largest grain"});
  r.number("granule_density_kg_m3", p.granule_density_kg_m3, {500, 4000, "kg/m3"},
           {"apparent density of a moist granule; the same for all powders of a line", {}, true});
  r.number("poured_bulk_density_kg_m3", p.poured_bulk_density_kg_m3, {300, 3000, "kg/m3"}, {"poured bulk density, moist", {}, true});
  if (p.psd.upper_cut_m < p.psd.lower_cut_m) r.issue("upper_cut_um", "the upper cut is below the lower cut", "swap upper_cut_um and lower_cut_um");
  if (p.poured_bulk_density_kg_m3 > 0.75 * p.granule_density_kg_m3)
    r.issue("poured_bulk_density_kg_m3", "more than 75 % of the granule density: no poured bed packs so tight",
            "expected 0.52 to 0.60 of granule_density_kg_m3");
}
}  // namespace

void read_slab(ObjectReader& r, LineBasics& b) {
  r.number("fired_width_mm", b.fired_width_m, {50, 2000, "mm", "belt width"}, {"across the belt, after firing and trimming"});
  r.number("fired_length_mm", b.fired_length_m, {50, 5000, "mm", "longest slab lines"}, {"along the belt"});
  r.number("fired_thickness_mm", b.fired_thickness_m, {3, 40, "mm"}, {"after firing"});
  r.number("firing_shrinkage_pct", b.firing_shrinkage, {0, 15, "%"}, {"linear; common to body and print", 7.0, true});
  r.number("drying_shrinkage_pct", b.drying_shrinkage, {0, 2, "%"}, {"linear, before printing", 0.1, true});
  r.number("nominal_springback_pct", b.nominal_springback, {0, 3, "%"},
           {"linear expansion out of the press that the line's set-up assumes when it sizes the deposit", 0.5, true});
  r.number("fired_density_kg_m3", b.fired_density_kg_m3, {1500, 3500, "kg/m3"}, {"bulk density of the fired slab", 2320.0, true});
  r.number("loss_on_ignition_pct", b.loss_on_ignition, {0, 20, "%"}, {"of the dry powder", 4.5, true});
  r.number("moisture_pct", b.moisture, {0, 12, "%"}, {"of the powder, dry basis", 5.5, true});
}

void read_powders(ObjectReader& r, LineBasics& b) {
  int bodies = 0, veins = 0;
  std::vector<PowderSpec> powders;
  r.objects("powders", "the powders of the line: one body, one vein", 2, 2, [&](ObjectReader& o, std::size_t) {
    PowderSpec p;
    bool body = true;
    const bool has_role = o.has("role");
    read_powder(o, p, body);
    if (has_role && body) b.body_powder = static_cast<int>(powders.size()), ++bodies;
    if (has_role && !body) b.vein_powder = static_cast<int>(powders.size()), ++veins;
    powders.push_back(p);
  });
  if (r.describing()) return;
  b.powders = powders;
  if (powders.size() != 2) return;
  if (bodies + veins == 2 && bodies != 1) r.issue("powders", "needs one powder with role body and one with role vein", "");
  if (powders[0].name == powders[1].name && !powders[0].name.empty())
    r.issue("powders", "two powders are called '" + powders[0].name + "'", "give each its own name");
  if (powders[0].granule_density_kg_m3 != powders[1].granule_density_kg_m3)
    r.issue("powders", "granule densities differ: mass and volume fractions would not be the same, which the operators assume",
            "use one granule_density_kg_m3 for both");
}

void read_materials(ObjectReader& r, LineBasics& b) {
  auto& t = b.materials;
  t.materials.assign(kMaterials, {});
  t.pairs.assign(kMaterials * kMaterials, {});
  dem::PairProperties grain, steel, belt;
  const char* names[kMaterials] = {"grain", "steel", "belt"};
  const char* helps[kMaterials] = {"granules of every powder", "hoppers, gates, prongs", "belt surface"};
  for (int m = 0; m < kMaterials; ++m) {
    auto& material = t.materials[static_cast<std::size_t>(m)];
    material.name = names[m];
    r.object(names[m], helps[m], [&](ObjectReader& o) { read_material(o, material, m == LineBasics::kGrain); });
  }
  r.object("grain_grain", "contact of two granules", [&](ObjectReader& o) { read_pair(o, grain); });
  r.object("grain_steel", "granule on steel", [&](ObjectReader& o) { read_pair(o, steel); });
  r.object("grain_belt", "granule on belt", [&](ObjectReader& o) { read_pair(o, belt); });
  // Walls never touch walls; their mutual entries repeat the steel pair so that no entry of the table is unset.
  for (auto& p : t.pairs) p = steel;
  const auto set = [&](int i, int j, const dem::PairProperties& p) {
    t.pairs[static_cast<std::size_t>(i * kMaterials + j)] = t.pairs[static_cast<std::size_t>(j * kMaterials + i)] = p;
  };
  set(LineBasics::kGrain, LineBasics::kGrain, grain);
  set(LineBasics::kGrain, LineBasics::kSteel, steel);
  set(LineBasics::kGrain, LineBasics::kBelt, belt);
}

void read_cut(ObjectReader& r, LineBasics& b) {
  r.number("offset_x_mm", b.cut_offset_x_m, {-50, 50, "mm"}, {"the cut slab's first corner against its nominal place on the strip", 0.0, true});
  r.number("offset_y_mm", b.cut_offset_y_m, {-50, 50, "mm"}, {"same, along the belt", 0.0, true});
  r.number("rotation_deg", b.cut_rotation_rad, {-3, 3, "deg"}, {"turn of the cut slab against the strip", 0.0, true});
}

void read_grid(ObjectReader& r, LineConfig& c) {
  r.number("pitch_mm", c.grid_pitch_m, {0.25, 10, "mm"}, {"columns of the bed, across and along", 1.0});
  r.integer("layers", c.basics.grid.nz, {2, 64, "1"}, {"mass layers of the bed, bottom to top", 10});
  r.number("lead_mm", c.grid_lead_m, {20, 3000, "mm"}, {"body powder before and after the design: room for delays and blurs", 150.0});
  r.number("trim_mm", c.grid_trim_m, {5, 200, "mm"},
           {"strip cut away on each side; veins run on into it, and as far beyond both ends of the design", 25.0});
  r.number("width_module_mm", c.width_module_m, {0.25, 100, "mm"},
           {"the bed is as wide as the design rounded up to whole modules (the prong pitch)", 5.0});
  if (c.grid_trim_m > c.grid_lead_m / 2)
    r.issue("trim_mm", "more than half of lead_mm", "raise lead_mm: the lead must hold the trim and room for delays");
  const double n = c.width_module_m / c.grid_pitch_m;
  if (std::isfinite(n) && std::abs(n - std::round(n)) > 1e-6)
    r.issue("pitch_mm", "the width module is not a whole number of columns", "choose a pitch that divides width_module_mm");
}
}  // namespace venato::line
