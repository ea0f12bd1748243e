#include "line/stages/piezo_discharge/slice.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/error.h"
#include "base/rng.h"
#include "base/units.h"
#include "line/response/response_operator.h"

namespace venato::line::piezo_discharge {
namespace {
constexpr int kLip = 0, kBelt = 1;
constexpr double kRainHeight_m = 0.012;  // band above the held level in which grains appear
}  // namespace

std::vector<PulseWindow> pulse_train(const Config& c, const LineBasics& basics) {
  return random_pulse_train(c.pulses, c.settle_s, c.min_on_pulse_s, c.max_on_pulse_s, c.min_on_pulse_s, c.max_on_pulse_s, basics.seed);
}

double train_duration(const Config& c, const std::vector<PulseWindow>& train) {
  // The last pulse still has to reach the belt: free fall plus the time a heap takes to let go (measured delays scatter by less than 0.1 s).
  return train.back().off_s + std::sqrt(2 * c.fall_m / kStandardGravity_m_s2) + 0.12;
}

dem::Case make_case(const Config& c, const LineBasics& basics, std::string_view name, double drive, const std::vector<PulseWindow>& on,
                    double duration_s) {
  SliceNumerics numerics = c.numerics;
  numerics.slice_width_m = std::max(numerics.slice_width_m, c.prong_pitch_m);
  const double top = c.hopper_height_m + kRainHeight_m + 0.004, lip = c.outlet_m + c.plate_m;
  dem::Case s = make_slice_case(basics, name, numerics, {basics.vein_powder}, -0.02, lip + 0.06, -c.fall_m - 0.005, top + 0.004);
  s.duration_s = duration_s;
  add_profile_wall(s, "hopper rear", {{0, top}, {0, 0.0001}}, LineBasics::kSteel);
  add_profile_wall(s, "hopper front", {{c.outlet_m, top}, {c.outlet_m, c.gap_m}}, LineBasics::kSteel);
  dem::WallMotion shake;
  shake.vibration_amplitude_m = drive * c.amplitude_m * Vec3(0, std::cos(c.angle_rad), std::sin(c.angle_rad));
  shake.vibration_hz = c.frequency_hz;
  for (const PulseWindow& p : on) shake.vibrate_when.push_back({p.on_s, p.off_s});
  add_profile_wall(s, "prong", {{-0.002, 0}, {lip, 0}}, LineBasics::kSteel, shake);

  dem::Fill fill;
  fill.low = Vec3(0, 0, 0.0005);
  fill.high = Vec3(numerics.slice_width_m, c.outlet_m, c.hopper_height_m + 0.8 * kRainHeight_m);
  fill.powder_mass_fractions = {1.0};
  s.fills.push_back(fill);
  dem::Rain rain;
  rain.name = "hopper feed";
  rain.low = Vec3(0, 0, c.hopper_height_m + 0.004);
  rain.high = Vec3(numerics.slice_width_m, c.outlet_m, top);
  rain.powder_mass_fractions = {1.0};
  // More than any opening passes: the level control is what sets the rate.
  rain.mass_rate_kg_s = 0.012 * numerics.slice_width_m / 0.005;
  rain.level_z_m = c.hopper_height_m;
  rain.velocity_m_s = Vec3(0, 0, -0.3);
  s.rains.push_back(rain);

  s.counters.resize(2);
  s.counters[kLip].name = "lip";
  s.counters[kLip].axis = 1;
  s.counters[kLip].position_m = c.outlet_m + 0.5 * c.plate_m;
  s.counters[kLip].sign = +1;
  s.counters[kBelt].name = "belt";
  s.counters[kBelt].axis = 2;
  s.counters[kBelt].position_m = -c.fall_m;
  s.counters[kBelt].sign = -1;
  s.counters[kBelt].remove = true;
  s.series.every_s = 0.005;
  return s;
}

namespace {
double mean_landing_y(const dem::CaseResult& result) {
  double mass = 0, moment = 0;
  for (const dem::CounterRecord& g : result.records[kBelt]) mass += g.mass_kg, moment += g.mass_kg * g.position_m.y();
  return mass > 0 ? moment / mass : 0;
}

/// Landing seen from the belt: a grain that lands dy downstream of the mean landing place meets belt that passed that place dy / v before, so it
/// counts as earlier.
std::vector<TimedMass> landing_times(double y_reference_m, const LineBasics& basics, const dem::CaseResult& result) {
  std::vector<TimedMass> landed;
  for (const dem::CounterRecord& g : result.records[kBelt])
    landed.push_back({g.time_s - (g.position_m.y() - y_reference_m) / basics.belt_speed_m_s, g.mass_kg});
  return landed;
}

/// Shift across the belt between the middle of the prong and the landing, one per grain.
std::vector<WeightedShift> lateral_shifts(const dem::CaseResult& result) {
  std::unordered_map<std::int64_t, double> x_at_lip;  // looked up by id only, never iterated
  for (const dem::CounterRecord& g : result.records[kLip]) x_at_lip.emplace(g.id, g.position_m.x());
  std::vector<WeightedShift> shifts;
  for (const dem::CounterRecord& g : result.records[kBelt])
    if (const auto it = x_at_lip.find(g.id); it != x_at_lip.end()) shifts.push_back({g.position_m.x() - it->second, g.mass_kg});
  return shifts;
}
}  // namespace

Operator characterise(const Config& c, const LineBasics& basics, const std::filesystem::path& folder, Context& context) {
  const std::vector<PulseWindow> train = pulse_train(c, basics);
  const double duration = train_duration(c, train);
  const dem::Case main_case = make_case(c, basics, "piezo_discharge pulses", 1.0, train, duration);
  const dem::CaseResult result = run_slice(main_case, folder / "pulses.ckpt", context);

  ResponseOperatorInput in;
  in.stage = "piezo_discharge";
  const double landing_y = mean_landing_y(result);
  in.landed = landing_times(landing_y, basics, result);
  in.shifts = lateral_shifts(result);
  in.pulses = train;
  in.start_s = c.settle_s;
  in.end_s = duration - 0.02;
  in.replicates = basics.bootstrap_replicates;
  in.seed = main_case.seed;
  in.lateral_bin_m = basics.grid.pitch_m / 4;
  Operator op = operator_from_response(in);

  const double width = main_case.box.high.x();
  const double per_prong = op.figures["mass_flow_kg_s"] * c.prong_pitch_m / width;
  op.figures["mass_flow_per_prong_kg_s"] = per_prong;
  op.figures["throw_m"] = landing_y - (c.outlet_m + c.plate_m);  // the dosing station on the belt lies this far downstream of the lip
  double leak = 0;
  for (const dem::CounterRecord& g : result.records[kBelt])
    if (g.time_s < c.settle_s) leak += g.mass_kg;
  op.figures["leak_kg_s"] = leak / c.settle_s * c.prong_pitch_m / width;
  op.figures["vibration_acceleration_g"] = c.amplitude_m * std::pow(2 * M_PI * c.frequency_hz, 2) / kStandardGravity_m_s2;

  // Steady flow at further drive levels: the static map from drive to flow.
  std::vector<double> drive{0.0}, flow{op.figures["leak_kg_s"] * 1e3};
  for (std::size_t k = 0; k < c.drive_levels.size(); ++k) {
    const double until = c.settle_s + kLevelTime_s;
    const std::string name = "piezo_discharge drive " + std::to_string(k);
    const dem::CaseResult level = run_slice(make_case(c, basics, name, c.drive_levels[k], {{c.settle_s, until}}, until),
                                            folder / ("drive" + std::to_string(k) + ".ckpt"), context);
    const double from = c.settle_s + op.reference_delay_s + 0.05;
    if (until - from < 0.1)
      throw WorkError("piezo_discharge: powder arrives only " + std::to_string(op.reference_delay_s) +
                      " s after the command, too late to measure the flow at further drive levels; set /drive/levels to []");
    double mass = 0;
    for (const dem::CounterRecord& g : level.records[kBelt])
      if (g.time_s >= from) mass += g.mass_kg;
    drive.push_back(c.drive_levels[k]);
    flow.push_back(mass / (until - from) * c.prong_pitch_m / width * 1e3);
  }
  drive.push_back(1.0);
  flow.push_back(per_prong * 1e3);
  op.curves["flow against drive"] = {{"drive", drive}, {"mass_flow_g_s", flow}};
  add_slice_figures(main_case, result, op);
  warn_if_too_coarse(basics, basics.vein_powder, c.numerics, "prong gap", c.gap_m, op.warnings);
  return op;
}
}  // namespace venato::line::piezo_discharge
