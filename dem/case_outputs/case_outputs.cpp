#include "dem/case_outputs/case_outputs.h"

#include "base/io/atomic_file.h"
#include "dem/case_outputs/csv.h"
#include "dem/case_outputs/field_plots.h"
#include "dem/case_outputs/labels.h"
#include "dem/case_outputs/plots.h"

namespace venato::dem {

void write_case_outputs(const std::filesystem::path& folder, const Case& c, const CaseResult& r) {
  make_output_folder(folder);
  write_case_result(folder / "result.h5", c, r);
  write_text_atomically(folder / "kpi.csv", kpi_csv(case_kpis(c, r)));
  write_text_atomically(folder / "series.csv", series_csv(c, r.series));
  for (std::size_t k = 0; k < r.records.size(); ++k)
    write_text_atomically(folder / ("counter_" + counter_label(c, k) + ".csv"), counter_csv(c, r.records[k]));
  if (!r.records.empty()) {
    write_text_atomically(folder / "counter_mass.svg", counter_mass_svg(c, r));
    write_text_atomically(folder / "flow_rate.svg", flow_rate_svg(c, r));
  }
  write_text_atomically(folder / "kinetic_energy.svg", kinetic_energy_svg(c, r));
  if (r.fields) {
    write_text_atomically(folder / "fields_plateau.svg", plateau_svg(c.name, r.fields->plateau, r.fields->fields.grid.width_m));
    write_text_atomically(folder / "fields_stress.svg", stress_profile_svg(c.name, r.fields->fields));
  }
  for (std::size_t k = 0; k < r.snapshots.size(); ++k) {
    const auto profile = height_profile(c, r.snapshots[k]);
    if (!profile) continue;
    const std::string name = "profile_" + std::to_string(k);
    write_text_atomically(folder / (name + "_velocity.svg"), velocity_profile_svg(c, *profile));
    write_text_atomically(folder / (name + "_solid_fraction.svg"), solid_fraction_profile_svg(c, *profile));
  }
}
}  // namespace venato::dem
