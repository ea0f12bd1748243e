#include "dem/case_outputs/case_outputs.h"

#include "base/io/atomic_file.h"
#include "dem/case_outputs/csv.h"
#include "dem/case_outputs/field_plots.h"
#include "dem/case_outputs/labels.h"
#include "dem/case_outputs/plots.h"

namespace venato::dem {

CaseReport report_case(const Case& c, const CaseResult& r) {
  CaseReport report;
  report.kpis = case_kpis(c, r);
  if (!c.rig || !r.complete) return report;
  RigResult rig = c.rig->measure(c, r);
  report.kpis.insert(report.kpis.end(), rig.kpis.begin(), rig.kpis.end());
  report.plots = std::move(rig.plots);
  report.tables = std::move(rig.tables);
  report.warnings = std::move(rig.warnings);
  return report;
}

CaseReport write_case_outputs(const std::filesystem::path& folder, const Case& c, const CaseResult& r) {
  CaseReport report = report_case(c, r);
  write_case_outputs(folder, c, r, report);
  return report;
}

void write_case_outputs(const std::filesystem::path& folder, const Case& c, const CaseResult& r, const CaseReport& report) {
  make_output_folder(folder);
  write_case_result(folder / "result.h5", c, r, report);
  write_text_atomically(folder / "kpi.csv", kpi_csv(report.kpis));
  for (const RigTable& table : report.tables) write_text_atomically(folder / (table.name + ".csv"), table_csv(table));
  for (const RigPlot& plot : report.plots) write_text_atomically(folder / (plot.name + ".svg"), svg_plot(plot.plot));
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
