#pragma once
/// Identification of a dosing device from one pseudo-random pulse train: how the mass flow below follows on/off commands above.
/// Model: f(t) = m_dot * sum over pulses of (box[on, off) * G)(t) with a gamma law G with dead time (mean, spread, shape): four numbers fitted by
/// least squares to the binned flow (Levenberg-Marquardt). A free-form G was tried first (Richardson-Lucy): with the few thousand grains of a short
/// slice it grew side lobes of noise that doubled the spread.
#include <cstdint>
#include <vector>
namespace venato::line {

struct PulseWindow {
  double on_s, off_s;
};
struct TimedMass {
  double time_s, mass_kg;
};  ///< one grain at the place of measurement

struct ResponseOptions {
  double bin_s = 0.005;          ///< of the flow the law is fitted to
  double kernel_bin_s = 0.0025;  ///< of the delay distribution returned
};
struct PulseResponse {
  std::vector<double> delay_s, weight;  ///< G: bin centres and weights (sum 1)
  double mass_flow_kg_s = 0;            ///< steady flow while on (fit over the whole train)
  double mean_delay_s = 0, sd_delay_s = 0;
  double latency_on_s = 0,
         latency_off_s = 0;         ///< switch to 50 % of the flow, from the aligned mean flow smoothed over 20 ms; NaN when no pulse is long enough
  double rise_s = 0;                ///< 10-90 % of the delay law
  double superposition_defect = 0;  ///< |f_on-aligned - model| / |model| over the averaged edges: how far the device is from linear
  double mass_per_pulse_error = 0;  ///< relative sd over pulses of measured / modelled pulse mass
  std::vector<double> edge_time_s, flow_after_on_kg_s, flow_after_off_kg_s, model_after_on_kg_s;  ///< aligned mean flows for the plot
};

/// Pulse train with on and off times drawn uniformly from [min, max]; deterministic in `seed`.
std::vector<PulseWindow> random_pulse_train(int pulses, double start_s, double min_on_s, double max_on_s, double min_off_s, double max_off_s,
                                            std::uint64_t seed);

/// \param end_s data is complete up to here. \throws WorkError when nothing was discharged.
/// \param block_weights one weight per pulse (bootstrap); empty = 1.
PulseResponse estimate_pulse_response(const std::vector<TimedMass>& landed, const std::vector<PulseWindow>& pulses, double start_s, double end_s,
                                      const ResponseOptions& options, const std::vector<double>& block_weights = {});
}  // namespace venato::line
