#include "dem/material_reader.h"

#include <limits>
#include <string>
#include <vector>

#include "dem/psd/check_sizes.h"

namespace venato::dem {
namespace {
constexpr std::size_t kMaxMaterials = 32;
const double kNan = std::numeric_limits<double>::quiet_NaN();
// Two walls never touch; the engine prepares a law for every pair and wants numbers that are allowed.
constexpr PairProperties kNeverTouch{1, 0, 0, 0};

void read_material(ObjectReader& r, Material& m) {
  r.name("name", m.name, {.help = "how powders, walls and pairs refer to it"});
  const auto elastic = [&m](ObjectReader& b) {
    b.number("young_modulus_mpa", m.young_modulus_pa, {0.01, 1e6, "MPa"}, {.help = "softened for the time step (10 MPa is usual for powders)"});
    b.number("poisson_ratio", m.poisson_ratio, {0, 0.49, ""}, {.help = "Poisson ratio"});
  };
  r.pick("kind", "what it is used for",
         {{"grain", "a powder is made of it",
           [&m, elastic](ObjectReader& b) {
             b.number("density_kg_m3", m.density_kg_m3, {100, 20000, "kg/m3"}, {.help = "of the grain (apparent), not of the bed"});
             elastic(b);
           }},
          {"wall", "only walls are made of it", elastic}});
}

std::string pair_name(const MaterialTable& t, std::size_t a, std::size_t b) {
  return "'" + t.materials[a].name + "' - '" + t.materials[b].name + "'";
}

void read_pair(ObjectReader& r, MaterialTable& table, std::vector<bool>& given) {
  const int a = read_material_name(r, "a", table, "one material of the pair");
  const int b = read_material_name(r, "b", table, "the other (may be the same)");
  PairProperties p{kNan, kNan, kNan, kNan};
  r.number("restitution", p.restitution, {0.01, 1, ""}, {.help = "measured coefficient of restitution; the damping is solved for it"});
  r.number("sliding_friction", p.sliding_friction, {0, 5, ""}, {.help = "Coulomb coefficient"});
  r.number("rolling_friction", p.rolling_friction, {0, 2, ""}, {.help = "mu_r of the elastic-plastic spring-dashpot model"});
  r.number("rolling_damping_ratio", p.rolling_damping_ratio, {0, 2, ""}, {.help = "eta_r of that model", .fallback = 0.3, .placeholder = true});
  if (a < 0 || b < 0) return;
  const std::size_t n = table.materials.size(), i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  if (given[i * n + j]) r.issue("", "the pair " + pair_name(table, i, j) + " is given twice", "remove one of the two");
  given[i * n + j] = given[j * n + i] = true;  // also when a number is bad: that has its own issue
  table.pairs[i * n + j] = table.pairs[j * n + i] = p;
}

void check_names(ObjectReader& r, const MaterialTable& table) {
  for (std::size_t k = 0; k < table.materials.size(); ++k)
    if (find_material(table, table.materials[k].name) != static_cast<int>(k) && !table.materials[k].name.empty())
      r.issue("materials", "the name '" + table.materials[k].name + "' is used twice", "names must differ");
}

void check_complete(ObjectReader& r, const MaterialTable& table, const std::vector<bool>& given) {
  const std::size_t n = table.materials.size();
  for (const Material& m : table.materials)
    if (m.name.empty()) return;  // already an issue; "missing" pairs would only repeat it
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a; b < n; ++b) {
      const bool grain = table.materials[a].density_kg_m3 > 0 || table.materials[b].density_kg_m3 > 0;
      if (grain && !given[a * n + b])
        r.issue("pairs", "the pair " + pair_name(table, a, b) + " is missing",
                "every pair with a grain material in it needs restitution and frictions");
    }
}
}  // namespace

int find_material(const MaterialTable& table, std::string_view name) {
  for (std::size_t k = 0; k < table.materials.size(); ++k)
    if (table.materials[k].name == name) return static_cast<int>(k);
  return -1;
}

std::string material_names(const MaterialTable& table) {
  std::string names;
  for (const Material& m : table.materials) names += (names.empty() ? "" : ", ") + m.name;
  return names;
}

int read_material_name(ObjectReader& r, std::string_view key, const MaterialTable& table, std::string_view help) {
  std::string name;
  r.name(key, name, {.help = help});
  if (name.empty()) return -1;
  const int index = find_material(table, name);
  if (index < 0) r.issue(key, "there is no material '" + name + "'", "known: " + material_names(table));
  return index;
}

void read_materials(ObjectReader& r, MaterialTable& table) {
  table = {};
  r.objects("materials", "materials of grains and walls", 1, kMaxMaterials, [&table](ObjectReader& item, std::size_t) {
    Material m;
    read_material(item, m);
    table.materials.push_back(m);
  });
  check_names(r, table);
  const std::size_t n = table.materials.size();
  table.pairs.assign(n * n, kNeverTouch);
  std::vector<bool> given(n * n, false);
  r.objects("pairs", "contact properties of every pair of materials with a grain in it", 1, kMaxMaterials * kMaxMaterials,
            [&](ObjectReader& item, std::size_t) { read_pair(item, table, given); });
  check_complete(r, table, given);
}

void read_powder(ObjectReader& r, const MaterialTable& table, Powder& powder) {
  r.name("name", powder.name, {.help = "name of the powder (its colour)"});
  const int material = read_material_name(r, "material", table, "grain material that it is made of");
  if (material >= 0) {
    powder.material = material;
    if (!(table.materials[static_cast<std::size_t>(material)].density_kg_m3 > 0))
      r.issue("material", "'" + table.materials[static_cast<std::size_t>(material)].name + "' is a wall material",
              "powders need a material of kind grain");
  }
  SizeDistribution& psd = powder.psd;
  psd = {};
  r.pick("sizes", "law of the grain diameters",
         {{"weibull", "two parameters, by mass, cut at both ends",
           [&psd](ObjectReader& b) {
             b.number("scale_um", psd.scale_m, {10, 20000, "um"}, {.help = "Weibull scale of the diameter by mass"});
             b.number("shape", psd.shape, {0.5, 30, ""}, {.help = "Weibull shape"});
             b.number("lower_cut_um", psd.lower_cut_m, {5, 20000, "um", "the number of grains per mass diverges without it"},
                      {.help = "smallest grain"});
             b.number("upper_cut_um", psd.upper_cut_m, {5, 50000, "um"}, {.help = "largest grain"});
             if (psd.lower_cut_m > 0 && psd.upper_cut_m > 0 && psd.scale_m > 0 && psd.shape > 0) {
               const std::string problem = size_distribution_problem(psd);
               if (!problem.empty()) b.issue("lower_cut_um", problem, "lower cut < upper cut");
             }
           }},
          {"monodisperse", "all grains alike", [&psd](ObjectReader& b) {
             b.number("diameter_um", psd.lower_cut_m, {5, 50000, "um"}, {.help = "diameter of every grain"});
             psd.upper_cut_m = psd.lower_cut_m;
           }}});
}
}  // namespace venato::dem
