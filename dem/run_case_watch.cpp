/// What is measured while a case runs, and the guard against blow-ups.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "dem/coarse_graining/openings.h"
#include "dem/run_case_state.h"
#include "dem/time_step.h"

namespace venato::dem {
namespace {
// The Hertz time falls with v^(1/5): at twice the expected speed the step is 15 % of it instead of 10 %, still stable; beyond, nothing is promised.
constexpr double kSpeedLimitFactor = 2;
constexpr double kDeepOverlap = 0.3;  // of the smaller radius: far outside Hertz theory

std::string likely_cause(const CaseRun& run) {
  const StepStatistics& s = run.sim.statistics();
  if (run.sim.step_number() < 50 && s.max_overlap > kDeepOverlap)
    return "grains overlap at the start; likely cause: fills, hand-over or walls that intersect; try to move the fill regions apart";
  if (s.max_overlap > kDeepOverlap)
    return "grains are squeezed by " + std::to_string(static_cast<int>(100 * s.max_overlap)) +
           " % of their radius; likely cause: a wall moved through grains, a wall that appears where grains lie, or a material that is too soft; "
           "try slower walls, later `present` times, or a larger Young's modulus";
  for (const Wall& w : run.c.walls)
    if (wall_speed(w, run.c.box) > 0.5 * run.c.expected_max_speed_m_s)
      return "likely cause: wall '" + w.name + "', which moves at up to " + std::to_string(wall_speed(w, run.c.box)) +
             " m/s, hit it; try a larger expected_max_speed_m_s (a hit throws grains at up to twice the wall's speed) or a slower wall";
  return "likely cause: the time step is too long for the speeds in this case, or grains fall farther than expected; "
         "try a larger expected_max_speed_m_s or a smaller time step";
}
std::int64_t due_step(double time_s, double dt) { return static_cast<std::int64_t>(std::ceil(time_s / dt * (1 - 1e-12))); }
}  // namespace

void watch_speed(CaseRun& run) {
  const StepStatistics& s = run.sim.statistics();
  const double limit = kSpeedLimitFactor * run.c.expected_max_speed_m_s;
  if (s.max_speed_m_s <= limit) return;
  const GrainState g = run.sim.grain(s.fastest);
  char line[512];
  std::snprintf(line, sizeof line,
                "grain %lld (d = %.3g mm, powder '%s') at (%.4g, %.4g, %.4g) mm reached %.3g m/s at t = %.5g s, limit %.3g m/s (%.0f x "
                "expected_max_speed_m_s = %.3g): ",
                static_cast<long long>(g.id), 2e3 * g.radius_m, run.c.powders[static_cast<std::size_t>(g.species)].name.c_str(),
                1e3 * g.position_m.x(), 1e3 * g.position_m.y(), 1e3 * g.position_m.z(), s.max_speed_m_s, run.sim.time_s(), limit, kSpeedLimitFactor,
                run.c.expected_max_speed_m_s);
  throw WorkError("DEM case '" + run.c.name + "': " + line + likely_cause(run));
}

void count_crossings(CaseRun& run) {
  if (run.c.counters.empty()) return;
  for (const Crossing& x : run.sim.take_crossings()) {
    const std::size_t k = static_cast<std::size_t>(x.counter);
    const Counter& counter = run.c.counters[k];
    if (!run.sim.has_grain(x.id)) continue;  // removed by another counter earlier in this step
    std::uint8_t& seen = run.seen[k][static_cast<std::size_t>(x.id)];
    if (seen && counter.first_only) continue;
    seen = 1;
    const GrainState g = run.sim.grain(x.id);
    const GrainBirth& birth = run.births[static_cast<std::size_t>(x.id)];
    run.result.records[k].push_back(
        {x.time_s, x.position_m, x.velocity_m_s, x.spin_rad_s, birth.position_m, birth.time_s, g.mass_kg, 2 * g.radius_m, x.id, g.species});
    run.counter_mass_kg[k] += g.mass_kg;
    if (counter.remove) run.take_out(x.id, run.result.mass_removed_kg);
  }
}

void remove_outside(CaseRun& run) {
  for (const GrainId id : run.sim.grains_outside(run.c.box)) run.take_out(id, run.result.mass_lost_box_kg);
}

namespace {
void sample_series(CaseRun& run) {
  TimeSeries& s = run.result.series;
  const double t = run.sim.time_s(), span = t - run.sampled_at_s;
  double mass = 0, top = -std::numeric_limits<double>::infinity(), kinetic = 0, fastest = 0;
  const std::vector<GrainState> grains = run.sim.grains();
  for (const GrainState& g : grains) {
    mass += g.mass_kg;
    top = std::max(top, g.position_m.z());
    const double v2 = g.velocity_m_s.squaredNorm();
    kinetic += 0.5 * g.mass_kg * (v2 + 0.4 * g.radius_m * g.radius_m * g.spin_rad_s.squaredNorm());
    fastest = std::max(fastest, std::sqrt(v2));
  }
  const double n = static_cast<double>(grains.size());
  s.time_s.push_back(t);
  s.grain_count.push_back(n);
  s.mass_kg.push_back(mass);
  s.kinetic_energy_j.push_back(kinetic);
  s.mean_contacts.push_back(n > 0 ? run.sim.mean_contacts() : 0);
  s.max_speed_m_s.push_back(fastest);
  s.top_z_m.push_back(n > 0 ? top : std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < run.c.counters.size(); ++k) s.counter_mass_kg[k].push_back(run.counter_mass_kg[k]);
  for (std::size_t w = 0; w < run.c.walls.size(); ++w) {
    const Vec3 impulse = run.sim.wall_impulse_n_s(static_cast<int>(w));
    s.wall_force_n[w].push_back(span > 0 ? Vec3((impulse - run.impulse_before[w]) / span) : Vec3(Vec3::Zero()));
    run.impulse_before[w] = impulse;
  }
  run.sampled_at_s = t;
}

}  // namespace

void observe(CaseRun& run) {
  const std::int64_t now = run.sim.step_number();
  const double dt = run.sim.time_step_s();
  // Longer intervals than dt only: frame k of a plan is taken at the first step at or after from + k * every.
  if (now >= due_step(static_cast<double>(run.samples) * run.c.series.every_s, dt)) {
    sample_series(run);
    while (now >= due_step(static_cast<double>(run.samples) * run.c.series.every_s, dt)) ++run.samples;
  }
  for (std::size_t k = 0; k < run.c.snapshots.size(); ++k) {
    const SnapshotPlan& p = run.c.snapshots[k];
    auto next = [&] { return p.from_s + static_cast<double>(run.frames[k]) * p.every_s; };
    if (!(next() < p.to_s - 1e-9 * p.every_s) || now < due_step(next(), dt)) continue;
    run.result.snapshots[k].push_back(snapshot_of(run.sim));
    while (next() < p.to_s - 1e-9 * p.every_s && now >= due_step(next(), dt)) ++run.frames[k];
  }
  if (run.fields) {
    const FieldPlan& p = *run.c.fields;
    auto next = [&] { return p.from_s + static_cast<double>(run.field_frames) * p.every_s; };
    if (next() < p.to_s - 1e-9 * p.every_s && now >= due_step(next(), dt)) {
      run.fields->take(run.sim);
      while (next() < p.to_s - 1e-9 * p.every_s && now >= due_step(next(), dt)) ++run.field_frames;
    }
  }
  if (run.c.vtk_every_s > 0 && !run.options.vtk_folder.empty() &&
      now >= due_step(static_cast<double>(run.vtk_times_s.size()) * run.c.vtk_every_s, dt))
    write_vtk(run);
  if (run.c.pictures.every_s > 0 && run.options.on_picture && now >= due_step(static_cast<double>(run.pictures) * run.c.pictures.every_s, dt))
    take_picture(run);
}

void finish_result(CaseRun& run) {
  remove_outside(run);
  CaseResult& r = run.result;
  if (run.fields && run.fields->has_frames()) r.fields = std::make_shared<const FieldResult>(run.fields->finish());
  r.steps = run.sim.step_number();
  r.end_time_s = run.sim.time_s();
  for (const GrainState& g : run.sim.grains()) {
    r.final_state.push_back({run.sim.time_s(), g.position_m, g.velocity_m_s, g.spin_rad_s, 2 * g.radius_m, g.species, g.id});
    r.mass_left_kg += g.mass_kg;
  }
  for (const RainState& s : run.rains) r.rain_starved_kg.push_back(std::max(0.0, s.due_kg));
  const StepStatistics& s = run.sim.statistics();
  r.max_speed_seen_m_s = s.max_speed_m_s;
  r.max_overlap_seen = s.max_overlap;
  char line[256];
  if (s.max_speed_m_s > run.c.expected_max_speed_m_s) {
    std::snprintf(
        line, sizeof line,
        "grains reached %.3g m/s, above expected_max_speed_m_s = %.3g: the time step is %.0f %% longer against the Hertz time than asked for",
        s.max_speed_m_s, run.c.expected_max_speed_m_s, 100 * (std::pow(s.max_speed_m_s / run.c.expected_max_speed_m_s, 0.2) - 1));
    r.warnings.emplace_back(line);
  }
  if (s.max_overlap > 0.1) {
    std::snprintf(line, sizeof line,
                  "grains overlapped by up to %.0f %% of their radius: outside Hertz theory (10 %%); a larger Young's modulus reduces it",
                  100 * s.max_overlap);
    r.warnings.emplace_back(line);
  }
  for (std::string& w : coarse_graining_warnings(run.c)) r.warnings.push_back(std::move(w));
  if (r.complete && !run.waiting.empty())
    r.warnings.push_back(std::to_string(run.waiting.size()) + " handed-over grains never found room or were born after the end");
  for (std::size_t k = 0; k < run.c.rains.size(); ++k)
    if (r.rain_starved_kg[k] > 1e-3 * run.c.rains[k].mass_rate_kg_s * run.c.duration_s) {
      std::snprintf(line, sizeof line, "rain '%s' could not place %.3g g for lack of room", run.c.rains[k].name.c_str(), 1e3 * r.rain_starved_kg[k]);
      r.warnings.emplace_back(line);
    }
  for (const std::string& w : r.warnings) run.context.log.warn("dem " + run.c.name + ": " + w);
}
}  // namespace venato::dem
