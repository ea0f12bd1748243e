#include "line/stages/powder_feeder/slice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "base/error.h"
#include "line/response/response_operator.h"

namespace venato::line::powder_feeder {
namespace {
constexpr double kTail_s = 0.3;           // after the last closing: the streams run dry
constexpr double kFeedBand_m = 0.016;     // rain band above the held hopper level
constexpr double kFeedSpeed_m_s = 0.8;    // fast enough that the rain is never what limits the flow
constexpr double kSealSlope = 0.4;        // the gate reaches so far beyond the outlet that powder in the gap above it rests at less than 22 degrees
constexpr double kHopperClear_m = 0.008;  // between outlet and the counter below it
}  // namespace

std::vector<std::vector<PulseWindow>> feeding_schedule(const Config& c, std::size_t powders) {
  std::vector<std::vector<PulseWindow>> schedule(powders);
  const double part = c.cycle_s / static_cast<double>(powders);
  for (std::size_t k = 0; k < powders; ++k)
    for (int cycle = 0; cycle < c.cycles; ++cycle) {
      // Each cycle's opening is a little shorter or longer than the last: equal pulses would not tell a delay from a delay plus one cycle.
      const double share = c.on_share * (1.0 + 0.15 * ((cycle % 3) - 1));
      const double on = c.settle_s + cycle * c.cycle_s + static_cast<double>(k) * part;
      schedule[k].push_back({on, on + share * part});
    }
  return schedule;
}

double case_duration(const Config& c) { return c.settle_s + c.cycles * c.cycle_s + kTail_s; }

dem::Case make_case(const Config& c, const LineBasics& basics) {
  const std::size_t n = basics.powders.size();
  std::vector<int> powders(n);
  std::iota(powders.begin(), powders.end(), 0);
  const double span = static_cast<double>(n - 1) * c.spacing_m + c.hopper_width_m;
  const double hopper_top = c.drop_m + c.hopper_height_m + kFeedBand_m + 0.004;
  const double reach = std::max(span / 2 + c.outlet_m + 0.03, c.throat_m / 2 + 0.01) + 0.01;
  dem::Case s = make_slice_case(basics, "powder_feeder cycle", c.numerics, powders, -reach, reach, -0.004, hopper_top + 0.004);
  s.duration_s = case_duration(c);

  // The funnel catches the outermost stream: it opens at its angle until it is wider than the row of hoppers, and stays below the gates.
  const double rim_z = c.drop_m - largest_grain_m(basics, c.numerics.coarse_graining) - 0.003;
  const double rim_half = std::min(reach - 0.004, c.throat_m / 2 + (rim_z - c.throat_height_m) / std::tan(c.funnel_angle_rad));
  for (const int side : {-1, 1})
    add_profile_wall(s, side < 0 ? "funnel rear" : "funnel front",
                     {{side * rim_half, rim_z}, {side * c.throat_m / 2, c.throat_height_m}, {side * c.throat_m / 2, -0.004}}, LineBasics::kSteel);
  const auto schedule = feeding_schedule(c, n);
  for (std::size_t k = 0; k < n; ++k) {
    const double middle = (static_cast<double>(k) - 0.5 * static_cast<double>(n - 1)) * c.spacing_m;
    const double low = middle - c.outlet_m / 2, high = middle + c.outlet_m / 2;
    const std::string name = basics.powders[k].name;
    // Upright bin above walls that converge to the outlet: without them the powder would fall through as a plug instead of flowing out (Beverloo).
    const double slope_z = c.drop_m + 0.5 * (c.hopper_width_m - c.outlet_m) * std::tan(c.hopper_angle_rad);
    const double bin_low = middle - c.hopper_width_m / 2, bin_high = middle + c.hopper_width_m / 2;
    add_profile_wall(s, "hopper rear " + name, {{bin_low, hopper_top}, {bin_low, slope_z}, {low, c.drop_m}}, LineBasics::kSteel);
    add_profile_wall(s, "hopper front " + name, {{bin_high, hopper_top}, {bin_high, slope_z}, {high, c.drop_m}}, LineBasics::kSteel);
    dem::WallMotion slide;
    // Gap of the largest grain: the closing gate crushes none, and the powder seals by its own angle of repose.
    const double play = largest_grain_m(basics, c.numerics.coarse_graining), gate_z = c.drop_m - play, overlap = play / kSealSlope;
    const double away = (middle >= 0 ? 1 : -1) * (c.outlet_m + overlap + 0.001);  // gates open outwards
    slide.track.push_back({0.0, Vec3::Zero()});
    for (const PulseWindow& p : schedule[k]) {
      slide.track.push_back({p.on_s, Vec3::Zero()});
      slide.track.push_back({p.on_s + c.gate_travel_time_s, Vec3(0, away, 0)});
      slide.track.push_back({p.off_s, Vec3(0, away, 0)});
      slide.track.push_back({p.off_s + c.gate_travel_time_s, Vec3::Zero()});
    }
    add_profile_wall(s, "actuator " + name, {{low - overlap, gate_z}, {high + overlap, gate_z}}, LineBasics::kSteel, slide);
    dem::Fill fill;
    fill.low = Vec3(0, bin_low, c.drop_m + 0.0005);
    fill.high = Vec3(c.numerics.slice_width_m, bin_high, c.drop_m + c.hopper_height_m + 0.8 * kFeedBand_m);
    fill.powder_mass_fractions.assign(n, 0.0);
    fill.powder_mass_fractions[k] = 1;
    s.fills.push_back(fill);
    dem::Rain rain;
    rain.name = "hopper feed " + name;
    rain.low = Vec3(0, bin_low, c.drop_m + c.hopper_height_m + 0.004);
    rain.high = Vec3(c.numerics.slice_width_m, bin_high, hopper_top);
    rain.powder_mass_fractions = fill.powder_mass_fractions;
    rain.mass_rate_kg_s = 0.03 * c.numerics.slice_width_m / 0.006;  // more than an outlet passes; the level control sets the rate
    rain.level_z_m = c.drop_m + c.hopper_height_m;
    rain.velocity_m_s = Vec3(0, 0, -kFeedSpeed_m_s);
    s.rains.push_back(rain);
    dem::Counter outlet;
    outlet.name = "outlet " + name;
    outlet.axis = 2;
    outlet.position_m = c.drop_m - kHopperClear_m;
    outlet.sign = -1;
    outlet.window_low.y() = middle - c.spacing_m / 2;
    outlet.window_high.y() = middle + c.spacing_m / 2;
    s.counters.push_back(outlet);
  }
  dem::Counter landing;
  landing.name = "landing";
  landing.axis = 2;
  landing.position_m = 0;
  landing.sign = -1;
  landing.remove = true;
  landing.window_low.y() = -c.throat_m / 2 - 0.001;
  landing.window_high.y() = c.throat_m / 2 + 0.001;
  s.counters.push_back(landing);
  return s;
}

Operator characterise(const Config& c, const LineBasics& basics, const std::filesystem::path& folder, Context& context) {
  const dem::Case slice = make_case(c, basics);
  const dem::CaseResult result = run_slice(slice, folder / "cycle.ckpt", context);
  const std::size_t n = basics.powders.size();
  const auto schedule = feeding_schedule(c, n);
  const std::vector<dem::CounterRecord>& landed = result.records[n];
  if (landed.empty()) throw WorkError("powder_feeder: no grain reached the bin; check outlet_mm, coarse_graining and the actuator times");

  ResponseOperatorInput in;
  in.stage = "powder_feeder";
  // The powders are laid end to end on one time axis: one response from all openings.
  const double length = slice.duration_s - c.settle_s;
  for (std::size_t k = 0; k < n; ++k)
    for (const PulseWindow& p : schedule[k])
      in.pulses.push_back({p.on_s + static_cast<double>(k) * length, p.off_s + static_cast<double>(k) * length});
  std::unordered_map<std::int64_t, double> x_at_outlet;  // looked up by id only
  for (std::size_t k = 0; k < n; ++k)
    for (const dem::CounterRecord& g : result.records[k]) x_at_outlet.emplace(g.id, g.position_m.x());
  for (const dem::CounterRecord& g : landed) {
    if (g.time_s < c.settle_s) continue;
    in.landed.push_back({g.time_s + static_cast<double>(g.species) * length, g.mass_kg});
    if (const auto it = x_at_outlet.find(g.id); it != x_at_outlet.end()) in.shifts.push_back({g.position_m.x() - it->second, g.mass_kg});
  }
  in.start_s = c.settle_s;
  in.end_s = c.settle_s + static_cast<double>(n) * length;
  in.replicates = basics.bootstrap_replicates;
  in.seed = slice.seed;
  in.lateral_bin_m = basics.grid.pitch_m / 4;
  Operator op = operator_from_response(in);

  // target(t) = mass landed in the target region / mass landed, per time bin; steady flow per powder; where each powder lands in the throat.
  const double bin = 0.02;
  const auto bins = static_cast<std::size_t>(std::ceil(slice.duration_s / bin));
  std::vector<double> time(bins), total(bins, 0.0), hit(bins, 0.0), target(bins);
  std::vector<std::vector<double>> flow(n, std::vector<double>(bins, 0.0));
  double all = 0, all_hit = 0;
  std::vector<double> steady(n, 0.0), steady_time(n, 0.0), place(n, 0.0), place_mass(n, 0.0);
  for (const dem::CounterRecord& g : landed) {
    const auto b = std::min(bins - 1, static_cast<std::size_t>(g.time_s / bin));
    const auto k = static_cast<std::size_t>(g.species);
    const bool inside = std::abs(g.position_m.y()) <= c.target_m / 2;
    total[b] += g.mass_kg;
    flow[k][b] += g.mass_kg / bin;
    all += g.mass_kg;
    if (inside) hit[b] += g.mass_kg, all_hit += g.mass_kg;
    place[k] += g.mass_kg * g.position_m.y();
    place_mass[k] += g.mass_kg;
    for (const PulseWindow& p : schedule[k])
      if (g.time_s >= p.on_s + op.reference_delay_s + 2 * op.figures["sd_delay_s"] && g.time_s < p.off_s + op.reference_delay_s)
        steady[k] += g.mass_kg;
  }
  for (std::size_t k = 0; k < n; ++k)
    for (const PulseWindow& p : schedule[k]) steady_time[k] += std::max(0.0, p.off_s - p.on_s - 2 * op.figures["sd_delay_s"]);
  for (std::size_t b = 0; b < bins; ++b) {
    time[b] = (static_cast<double>(b) + 0.5) * bin;
    target[b] = total[b] > 0 ? 1 - (total[b] - hit[b]) / total[b] : std::nan("");
  }
  op.figures["target"] = all > 0 ? all_hit / all : std::nan("");
  op.curves["target"] = {{"time_s", time}, {"target", target}};
  op.curves["mass flow per powder"]["time_s"] = time;
  double lowest = HUGE_VAL, highest = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::string& name = basics.powders[k].name;
    const double rate = steady_time[k] > 0 ? steady[k] / steady_time[k] / slice.box.high.x() : std::nan("");
    op.figures["mass_flow_" + name + "_kg_s_m"] = rate;
    op.figures["landing_offset_" + name + "_m"] = place_mass[k] > 0 ? place[k] / place_mass[k] : std::nan("");
    op.curves["mass flow per powder"][name + "_kg_s"] = flow[k];
    lowest = std::min(lowest, rate);
    highest = std::max(highest, rate);
  }
  op.figures["mass_flow_unevenness"] = highest > 0 ? (highest - lowest) / highest : std::nan("");
  add_slice_figures(slice, result, op);
  warn_if_too_coarse(basics, basics.body_powder, c.numerics, "hopper outlet", c.outlet_m, op.warnings);
  return op;
}
}  // namespace venato::line::powder_feeder
