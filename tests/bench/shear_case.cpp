#include "tests/bench/shear_case.h"

#include <fstream>
#include <sstream>

#include "base/error.h"

namespace venato::bench {

std::vector<ShearCase> read_cases(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw UsageError("cannot read " + file.string());
  std::vector<ShearCase> cases;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    ShearCase c;
    double skin_liggghts_m = 0, skin_lammps_m = 0;
    words >> c.name >> c.psd >> c.tiles_x >> c.tiles_y >> c.time_step_s >> c.floor_m_s >> c.warmup_steps >> c.window_steps >> skin_liggghts_m >>
        skin_lammps_m;
    if (!words || c.tiles_x < 1 || c.tiles_y < 1 || !(c.time_step_s > 0) || c.warmup_steps < 0 || c.window_steps < 1)
      throw UsageError(file.string() + ": not a case: " + line);
    cases.push_back(c);
  }
  return cases;
}

ShearCase find_case(const std::vector<ShearCase>& cases, const std::string& name) {
  std::string known;
  for (const ShearCase& c : cases) {
    if (c.name == name) return c;
    known += " " + c.name;
  }
  throw UsageError("unknown case '" + name + "'; known:" + known);
}

dem::MaterialTable bench_materials() { return {{{"powder", 2000, 1e7, 0.25}}, {{0.4, 0.5, 0.1, 0.3}}}; }

dem::SizeDistribution bench_sizes(const std::string& psd) {
  if (psd == "mono") return {380e-6, 2.7, 380e-6, 380e-6};
  if (psd == "poly") return {380e-6, 2.7, 200e-6, 700e-6};
  throw UsageError("unknown size distribution '" + psd + "'; known: mono poly");
}
}  // namespace venato::bench
