#pragma once
#include <string>
#include <vector>
#include "dem/run_case.h"
#include "line/products/operator.h"
#include "line/response/pulse_response.h"
namespace venato::line {

struct WeightedShift {
  double shift_m, mass_kg;
};

struct ResponseOperatorInput {
  std::string stage;
  std::vector<TimedMass> landed;
  std::vector<WeightedShift> shifts;  ///< across the belt
  std::vector<PulseWindow> pulses;
  double start_s = 0, end_s = 0;
  ResponseOptions options;
  int replicates = 16;  ///< bootstrap over pulses (drawn with replacement)
  std::uint64_t seed = 0;
  double lateral_bin_m = 0.00025;
};

/// Kernel of a dosing device: delay distribution G(theta) of the identified pulse response times the distribution of lateral shifts (independent of
/// each other: a grain's delay is set in the device, its sideways scatter in the fall). Figures: mass_flow_kg_s, latency_on_s, latency_off_s, rise_s,
/// mean_delay_s, sd_delay_s, sd_lateral_m, superposition_defect, pulse_mass_scatter. Curve "step response".
Operator operator_from_response(const ResponseOperatorInput& input);

/// Figures every slice reports: grains, time step, steps, largest overlap and speed, coarse graining; warnings are passed on.
void add_slice_figures(const dem::Case& c, const dem::CaseResult& r, Operator& op);
}  // namespace venato::line
