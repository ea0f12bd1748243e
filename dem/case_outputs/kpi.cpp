#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dem/case_outputs/case_outputs.h"
#include "dem/case_outputs/labels.h"

namespace venato::dem {
namespace {
const double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBlocks = 8;
constexpr std::size_t kFewestCrossings = 20;  // fewer say nothing about eight blocks
constexpr double kGrams = 1e3;

void add_counter(std::vector<Kpi>& kpis, const Case& c, std::size_t k, const std::vector<CounterRecord>& records) {
  const std::string name = counter_label(c, k);
  double mass = 0, time = 0, residence = 0;
  std::vector<double> share(c.powders.size(), 0);
  for (const CounterRecord& r : records) {
    mass += r.mass_kg;
    time += r.mass_kg * r.time_s;
    residence += r.mass_kg * (r.time_s - r.birth_time_s);
    if (r.species >= 0 && static_cast<std::size_t>(r.species) < share.size()) share[static_cast<std::size_t>(r.species)] += r.mass_kg;
  }
  const FlowEstimate flow = steady_flow(records);
  kpis.push_back({name + ".grains", static_cast<double>(records.size()), kNan, "1", "grains that crossed"});
  kpis.push_back({name + ".mass_g", mass * kGrams, kNan, "g", "their mass"});
  kpis.push_back({name + ".mass_flow_g_s", flow.mean_kg_s * kGrams, flow.standard_error_kg_s * kGrams, "g/s",
                  "flow while 10 % to 90 % of the mass crossed", "8 time blocks"});
  kpis.push_back({name + ".flow_from_s", flow.from_s, kNan, "s", "start of that window"});
  kpis.push_back({name + ".flow_to_s", flow.to_s, kNan, "s", "end of that window"});
  kpis.push_back({name + ".mean_time_s", mass > 0 ? time / mass : kNan, kNan, "s", "mean time of crossing, by mass"});
  kpis.push_back({name + ".mean_residence_s", mass > 0 ? residence / mass : kNan, kNan, "s", "mean time from birth to crossing, by mass"});
  for (std::size_t p = 0; p < share.size(); ++p)
    kpis.push_back({name + ".share_" + powder_label(c, p), mass > 0 ? share[p] / mass : kNan, kNan, "1",
                    "target: 1 - (m_total - m_powder) / m_total of what crossed"});
}
}  // namespace

FlowEstimate steady_flow(const std::vector<CounterRecord>& records) {
  FlowEstimate flow{kNan, kNan, kNan, kNan};
  if (records.size() < kFewestCrossings) return flow;
  double total = 0, so_far = 0;
  for (const CounterRecord& r : records) total += r.mass_kg;
  for (const CounterRecord& r : records) {  // in order of time
    so_far += r.mass_kg;
    if (std::isnan(flow.from_s) && so_far >= 0.1 * total) flow.from_s = r.time_s;
    if (so_far >= 0.9 * total) {
      flow.to_s = r.time_s;
      break;
    }
  }
  const double length = (flow.to_s - flow.from_s) / kBlocks;
  if (!(length > 0)) return flow;
  std::array<double, kBlocks> block{};
  for (const CounterRecord& r : records) {
    // (from, to]: the crossing that opens the window belongs to the 10 % before it.
    if (r.time_s <= flow.from_s || r.time_s > flow.to_s) continue;
    const auto b = static_cast<std::size_t>(std::min(std::floor((r.time_s - flow.from_s) / length), static_cast<double>(kBlocks - 1)));
    block[b] += r.mass_kg / length;
  }
  flow.mean_kg_s = 0;
  for (double b : block) flow.mean_kg_s += b / kBlocks;
  double variance = 0;
  for (double b : block) variance += (b - flow.mean_kg_s) * (b - flow.mean_kg_s) / (kBlocks - 1);
  flow.standard_error_kg_s = std::sqrt(variance / kBlocks);
  return flow;
}

std::vector<Kpi> case_kpis(const Case& c, const CaseResult& r) {
  std::vector<Kpi> kpis;
  kpis.push_back({"time_step_us", r.time_step_s * 1e6, kNan, "us", "time step"});
  kpis.push_back({"steps", static_cast<double>(r.steps), kNan, "1", "steps done"});
  kpis.push_back({"coarse_graining", c.coarse_graining, kNan, "1", "grain diameters are the powder's times this"});
  kpis.push_back({"mass_put_in_g", r.mass_put_in_kg * kGrams, kNan, "g", "mass of all grains put in"});
  kpis.push_back({"mass_removed_g", r.mass_removed_kg * kGrams, kNan, "g", "mass taken out by counters"});
  kpis.push_back({"mass_lost_box_g", r.mass_lost_box_kg * kGrams, kNan, "g", "mass of grains that left the box"});
  kpis.push_back({"mass_left_g", r.mass_left_kg * kGrams, kNan, "g", "mass in the box at the end"});
  kpis.push_back({"grains_left", static_cast<double>(r.final_state.size()), kNan, "1", "grains in the box at the end"});
  kpis.push_back({"max_speed_m_s", r.max_speed_seen_m_s, kNan, "m/s", "largest speed seen"});
  kpis.push_back({"max_overlap", r.max_overlap_seen, kNan, "1", "largest overlap over the radius of the smaller grain"});
  for (std::size_t k = 0; k < r.rain_starved_kg.size() && k < c.rains.size(); ++k)
    kpis.push_back({c.rains[k].name + ".starved_g", r.rain_starved_kg[k] * kGrams, kNan, "g", "mass that did not fit into the rain's region"});
  for (std::size_t k = 0; k < r.records.size(); ++k) add_counter(kpis, c, k, r.records[k]);
  return kpis;
}
}  // namespace venato::dem
