#include "line/response/response_operator.h"

#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "line/products/operator_with_replicates.h"

namespace venato::line {
namespace {

struct LateralHistogram {
  double bin_m;
  std::vector<double> centre_m, weight;
  double sd_m;
};

LateralHistogram lateral_histogram(const std::vector<WeightedShift>& shifts, double bin_m) {
  LateralHistogram h{bin_m, {0.0}, {1.0}, 0.0};
  double mass = 0, second = 0, reach = 0;
  for (const WeightedShift& s : shifts) mass += s.mass_kg, second += s.mass_kg * s.shift_m * s.shift_m, reach = std::max(reach, std::abs(s.shift_m));
  if (!(mass > 0)) return h;
  const int half = static_cast<int>(std::ceil(reach / bin_m));
  h.centre_m.clear();
  h.weight.assign(static_cast<std::size_t>(2 * half + 1), 0.0);
  for (int k = -half; k <= half; ++k) h.centre_m.push_back(k * bin_m);
  for (const WeightedShift& s : shifts) {
    const double pos = s.shift_m / bin_m + half;
    const auto k = static_cast<std::size_t>(std::lround(pos));
    h.weight[std::min(k, h.weight.size() - 1)] += s.mass_kg / mass;
  }
  h.sd_m = std::sqrt(second / mass);
  return h;
}

std::vector<Landing> landings_of(const PulseResponse& r, const LateralHistogram& h) {
  std::vector<Landing> out;
  for (std::size_t i = 0; i < r.weight.size(); ++i) {
    if (r.weight[i] < 1e-9) continue;  // far tail: 1e-9 of the mass, renormalised by operator_from_landings
    for (std::size_t j = 0; j < h.weight.size(); ++j)
      if (h.weight[j] > 0) out.push_back({0, 0, r.delay_s[i], h.centre_m[j], r.weight[i] * h.weight[j]});
  }
  return out;
}
}  // namespace

Operator operator_from_response(const ResponseOperatorInput& in) {
  const PulseResponse best = estimate_pulse_response(in.landed, in.pulses, in.start_s, in.end_s, in.options);
  const LateralHistogram lateral = lateral_histogram(in.shifts, in.lateral_bin_m);
  const std::vector<Landing> landings = landings_of(best, lateral);
  std::vector<std::vector<Landing>> sets{landings};
  for (int k = 0; k < in.replicates; ++k) {
    Rng rng(in.seed, stream_id("line/pulse_bootstrap"), static_cast<std::uint64_t>(k));
    std::vector<double> weights(in.pulses.size(), 0.0);
    for (std::size_t p = 0; p < weights.size(); ++p) weights[rng.below(weights.size())] += 1;
    sets.push_back(landings_of(estimate_pulse_response(in.landed, in.pulses, in.start_s, in.end_s, in.options, weights), lateral));
  }
  Operator op = operator_with_replicates(in.stage, sets, 1, 1, in.options.kernel_bin_s, in.lateral_bin_m, false);
  op.figures["mass_flow_kg_s"] = best.mass_flow_kg_s;
  op.figures["mean_delay_s"] = best.mean_delay_s;
  op.figures["sd_delay_s"] = best.sd_delay_s;
  op.figures["sd_lateral_m"] = lateral.sd_m;
  op.figures["latency_on_s"] = best.latency_on_s;
  op.figures["latency_off_s"] = best.latency_off_s;
  op.figures["rise_s"] = best.rise_s;
  op.figures["superposition_defect"] = best.superposition_defect;
  op.figures["pulse_mass_scatter"] = best.mass_per_pulse_error;
  if (!(best.superposition_defect <= 0.15))
    op.warnings.push_back("response is not linear: superposition defect " + std::to_string(best.superposition_defect) +
                          " > 0.15 (pulses of other lengths may differ)");
  op.curves["step response"] = {{"time_s", best.edge_time_s},
                                {"after_on_kg_s", best.flow_after_on_kg_s},
                                {"after_off_kg_s", best.flow_after_off_kg_s},
                                {"model_after_on_kg_s", best.model_after_on_kg_s}};
  op.curves["delay distribution"] = {{"delay_s", best.delay_s}, {"weight", best.weight}};
  return op;
}

void add_slice_figures(const dem::Case& c, const dem::CaseResult& r, Operator& op) {
  op.figures["coarse_graining"] = c.coarse_graining;
  op.figures["grains_at_end"] = static_cast<double>(r.final_state.size());
  op.figures["time_step_s"] = r.time_step_s;
  op.figures["steps"] = static_cast<double>(r.steps);
  op.figures["largest_overlap"] = r.max_overlap_seen;
  op.figures["largest_speed_m_s"] = r.max_speed_seen_m_s;
  op.figures["simulated_s"] = c.duration_s;
  for (const std::string& w : r.warnings)
    // Feeds under level control are meant to offer more than fits.
    if (w.find("for lack of room") == std::string::npos) op.warnings.push_back(w);
}
}  // namespace venato::line
