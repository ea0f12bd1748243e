#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "dem/case.h"
#include "dem/kpi.h"
#include "dem/rigs/rig_api.h"
#include "dem/run_case.h"
namespace venato::dem {

/// Everything measured from a finished case.
struct CaseReport {
  std::vector<Kpi> kpis;               ///< of the case, then of its rig
  std::vector<RigPlot> plots;          ///< of its rig
  std::vector<RigTable> tables;
  std::vector<std::string> warnings;   ///< of its rig
};
/// A run that was stopped before its end (CaseResult::complete) is not measured by its rig.
CaseReport report_case(const Case& c, const CaseResult& r);

/// Writes what `venato dem` leaves in its folder (made when missing): result.h5, kpi.csv, series.csv, counter_<name>.csv, and the plots
/// counter_mass.svg, flow_rate.svg, kinetic_energy.svg, profile_<n>_velocity.svg and profile_<n>_solid_fraction.svg (one pair per snapshot plan
/// with at least 3 frames), fields_plateau.svg and fields_stress.svg (with Case::fields); of a rig its tables (<name>.csv) and plots (<name>.svg). Same case and result, same bytes; no wall-clock times.
/// \throws WorkError, UsageError naming the file.
void write_case_outputs(const std::filesystem::path& folder, const Case& c, const CaseResult& r, const CaseReport& report);
CaseReport write_case_outputs(const std::filesystem::path& folder, const Case& c, const CaseResult& r);

/// Of the case alone.
std::vector<Kpi> case_kpis(const Case& c, const CaseResult& r);
/// For people: one aligned line per KPI, "name  value +- error unit  (error from)"; NaN as "not known".
std::string kpi_text(const std::vector<Kpi>& kpis);

/// Steady mass flow over a counter between the times at which 10 % and 90 % of its mass had crossed (what comes before is filling or opening, what
/// comes after is running empty): mean and standard error of 8 equal blocks. NaN with fewer than 20 crossings.
struct FlowEstimate {
  double mean_kg_s, standard_error_kg_s, from_s, to_s;
};
FlowEstimate steady_flow(const std::vector<CounterRecord>& records);
}  // namespace venato::dem
