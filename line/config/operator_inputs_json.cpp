#include <nlohmann/json.hpp>

#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "line/config/line_config.h"
namespace venato::line {
namespace {
using Json = nlohmann::json;

void collect_files(const Json& node, const std::filesystem::path& folder, Json& out) {
  if (node.is_structured()) {
    for (const auto& child : node) collect_files(child, folder, out);
  } else if (node.is_string() && !node.get<std::string>().empty()) {
    const auto file = folder / node.get<std::string>();
    std::error_code none;
    if (std::filesystem::is_regular_file(file, none)) out[node.get<std::string>()] = sha256_hex(read_file(file));
  }
}
}  // namespace

std::string material_inputs_json(const LineBasics& b) {
  Json powders = Json::array(), materials = Json::array(), pairs = Json::array();
  for (const auto& p : b.powders)
    powders.push_back({{"scale_m", p.psd.scale_m},
                       {"shape", p.psd.shape},
                       {"lower_cut_m", p.psd.lower_cut_m},
                       {"upper_cut_m", p.psd.upper_cut_m},
                       {"granule_density_kg_m3", p.granule_density_kg_m3},
                       {"poured_bulk_density_kg_m3", p.poured_bulk_density_kg_m3}});
  for (const auto& m : b.materials.materials) materials.push_back({{"young_modulus_pa", m.young_modulus_pa}, {"poisson_ratio", m.poisson_ratio}});
  for (const auto& p : b.materials.pairs)
    pairs.push_back({{"restitution", p.restitution},
                     {"sliding_friction", p.sliding_friction},
                     {"rolling_friction", p.rolling_friction},
                     {"rolling_damping_ratio", p.rolling_damping_ratio}});
  return Json{{"powders", powders}, {"body", b.body_powder}, {"vein", b.vein_powder}, {"materials", materials}, {"pairs", pairs}}.dump();
}

std::string operator_inputs_json(const LineBasics& b) {
  // Colours and the size of the slab are left out on purpose: a slice of the line knows nothing of them, so a larger slab reuses the operators.
  Json names = Json::array();
  for (const auto& p : b.powders) names.push_back(p.name);
  return Json{{"materials", Json::parse(b.material_inputs_json)},
              {"belt_speed_m_s", b.belt_speed_m_s},
              {"bed_mass_kg_m2", b.bed_mass_kg_m2},
              {"nominal_springback", b.nominal_springback},
              {"moisture", b.moisture},
              {"layers", b.grid.nz},
              {"grid_pitch_m", b.grid.pitch_m},  // kernels are binned in fractions of it
              {"powder_names", names},           // figures and curves are named after them
              {"seed", b.seed},
              {"bootstrap_replicates", b.bootstrap_replicates}}
      .dump();
}

std::string file_hashes_json(const std::string& stage_inputs_json, const std::filesystem::path& folder) {
  Json out = Json::object();
  collect_files(Json::parse(stage_inputs_json), folder, out);
  return out.empty() ? "" : out.dump();
}
}  // namespace venato::line
