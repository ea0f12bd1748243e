#include "dem/run_case.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>

#include "base/error.h"
#include "base/rng.h"
#include "dem/run_case_state.h"

namespace venato::dem {
namespace {
using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr std::int64_t kOutflowEvery = 16, kClockEvery = 16;  // steps

SimulationSetup setup_of(const Case& c, const Context& context, double dt) {
  SimulationSetup s;
  s.materials = c.materials;
  s.law = c.law;
  s.eepa = c.eepa;
  s.box = c.box;
  s.gravity_m_s2 = c.gravity_m_s2;
  s.time_step_s = dt;
  s.threads = std::max(1, context.threads);
  return s;
}

void check_case(const Case& c) {
  auto fail = [&](const std::string& why) { throw UsageError("DEM case '" + c.name + "': " + why); };
  if (!(c.duration_s > 0) || !std::isfinite(c.duration_s)) fail("duration " + std::to_string(c.duration_s) + " s is not > 0");
  if (!(c.coarse_graining >= 1)) fail("coarse graining " + std::to_string(c.coarse_graining) + " is outside [1, inf)");
  if (!(c.expected_max_speed_m_s > 0)) fail("expected_max_speed_m_s is not > 0");
  for (int a = 0; a < 3; ++a)
    if (!(c.box.high[a] > c.box.low[a])) fail(std::string("the box has no extent along ") + "xyz"[a]);
  for (const Powder& p : c.powders)
    if (p.material < 0 || static_cast<std::size_t>(p.material) >= c.materials.materials.size())
      fail("powder '" + p.name + "' names a material that is not in the table");
  auto fractions = [&](const std::vector<double>& f, const std::string& who) {
    if (f.size() != c.powders.size())
      fail(who + " has " + std::to_string(f.size()) + " powder fractions for " + std::to_string(c.powders.size()) + " powders");
    if (!(std::abs(std::accumulate(f.begin(), f.end(), 0.0) - 1) < 1e-6)) fail(who + ": its powder mass fractions do not add up to 1");
    if (std::any_of(f.begin(), f.end(), [](double v) { return !(v >= 0); })) fail(who + " has a negative powder fraction");
  };
  auto inside = [&](const Vec3& low, const Vec3& high, const std::string& who) {
    for (int a = 0; a < 3; ++a)
      if (!(low[a] <= high[a]) || low[a] < c.box.low[a] - 1e-12 || high[a] > c.box.high[a] + 1e-12)
        fail(who + " spans " + std::to_string(low[a] * 1e3) + " … " + std::to_string(high[a] * 1e3) + " mm along " + "xyz"[a] +
             ", outside the box (" + std::to_string(c.box.low[a] * 1e3) + " … " + std::to_string(c.box.high[a] * 1e3) + " mm)");
  };
  for (std::size_t k = 0; k < c.fills.size(); ++k) inside(c.fills[k].low, c.fills[k].high, "fill " + std::to_string(k));
  for (std::size_t k = 0; k < c.fills.size(); ++k)
    if (c.fills[k].solid_fraction > 0 && c.fills[k].mass_kg > 0)
      fail("fill " + std::to_string(k) + " gives both a solid fraction (dense packing) and a mass (lattice)");
  for (const Rain& r : c.rains) inside(r.low, r.high, "rain '" + r.name + "'");
  for (std::size_t k = 0; k < c.fills.size(); ++k) fractions(c.fills[k].powder_mass_fractions, "fill " + std::to_string(k));
  for (const Rain& r : c.rains) fractions(r.powder_mass_fractions, "rain '" + r.name + "'");
  for (const GrainRecord& g : c.handed_over)
    if (g.species < 0 || static_cast<std::size_t>(g.species) >= c.powders.size())
      fail("a handed-over grain has species " + std::to_string(g.species) + ", which is no powder");
  for (const SnapshotPlan& p : c.snapshots)
    if (!(p.every_s > 0) || !(p.to_s >= p.from_s)) fail("a snapshot plan needs every_s > 0 and to_s >= from_s");
  if (c.fields && (!(c.fields->every_s > 0) || !(c.fields->to_s > c.fields->from_s))) fail("the field plan needs every_s > 0 and to_s > from_s");
  if (!(c.series.every_s > 0)) fail("series.every_s is not > 0");
}

void log_profile(const CaseRun& run) {
  const StepStatistics& s = run.sim.statistics();
  const double all = s.seconds_list + s.seconds_scan + s.seconds_contact + s.seconds_integrate + s.seconds_walls;
  char line[256];
  std::snprintf(line, sizeof line,
                "dem %s  profile: list %.1f %%  scan %.1f %%  contact %.1f %%  sum and integrate %.1f %%  walls %.1f %%  of %.2f s; %lld list "
                "builds in %lld steps",
                run.c.name.c_str(), 100 * s.seconds_list / all, 100 * s.seconds_scan / all, 100 * s.seconds_contact / all,
                100 * s.seconds_integrate / all, 100 * s.seconds_walls / all, all, static_cast<long long>(s.list_builds),
                static_cast<long long>(s.steps));
  run.context.log.info(line);
}

/// Progress bar, stop request and checkpoints: looked at every few steps, never part of the results.
class Keeper {
 public:
  Keeper(CaseRun& run, std::int64_t steps) : run_(run), start_(Clock::now()), saved_(start_) {
    run.context.progress.begin("dem " + run.c.name, static_cast<double>(steps), "steps");
    work_before_ = run.result.particle_steps;
  }
  ~Keeper() { run_.context.progress.end(); }
  double elapsed_s() const { return seconds_since(start_); }

  void look() {
    const double t = seconds_since(start_), rate = t > 0 ? (run_.result.particle_steps - work_before_) / t : 0;
    char extra[96];
    std::snprintf(extra, sizeof extra, "t = %.4f s  %zu grains  %.2f M particle-steps/s", run_.sim.time_s(), run_.sim.grain_count(), rate * 1e-6);
    run_.context.progress.at(static_cast<double>(run_.sim.step_number()), extra);
    const bool stop = run_.context.stop_requested();
    const std::filesystem::path& file = run_.options.checkpoint;
    if (!file.empty() && (stop || seconds_since(saved_) >= run_.options.checkpoint_every_wall_s)) {
      save_checkpoint(run_, file);
      saved_ = Clock::now();
    }
    if (stop)
      throw Interrupted("DEM case '" + run_.c.name + "' stopped at t = " + std::to_string(run_.sim.time_s()) + " s" +
                        (file.empty() ? "" : "; its state is in " + file.string()));
  }

 private:
  CaseRun& run_;
  Clock::time_point start_, saved_;
  double work_before_ = 0;
};
}  // namespace

CaseRun::CaseRun(const Case& case_, const RunOptions& options_, Context& context_, double dt)
    : c(case_), options(options_), context(context_), sim(setup_of(case_, context_, dt)) {
  for (const Wall& w : c.walls) sim.add_wall(w);
  sim.set_counters(c.counters);
  for (std::size_t k = 0; k < c.rains.size(); ++k) rain_streams.emplace_back(c, c.rains[k].powder_mass_fractions, stream_id("dem/rain") + k);
  rains.resize(c.rains.size());
  seen.resize(c.counters.size());
  counter_mass_kg.resize(c.counters.size());
  impulse_before.assign(c.walls.size(), Vec3::Zero());
  frames.resize(c.snapshots.size());
  if (c.fields) fields.emplace(c.box, *c.fields, c.gravity_m_s2, c.coarse_graining);
  waiting.resize(c.handed_over.size());
  std::iota(waiting.begin(), waiting.end(), 0u);
  std::stable_sort(waiting.begin(), waiting.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return c.handed_over[a].time_s < c.handed_over[b].time_s; });
  result.time_step_s = dt;
  result.records.resize(c.counters.size());
  result.series.counter_mass_kg.resize(c.counters.size());
  result.series.wall_force_n.resize(c.walls.size());
  result.snapshots.resize(c.snapshots.size());
}

namespace {
void resume(CaseRun& run, std::int64_t steps) {
  load_checkpoint(run, run.options.checkpoint);
  char line[200];
  std::snprintf(line, sizeof line, "dem %s  goes on from t = %.6g s (%.0f %% of its steps)", run.c.name.c_str(), run.sim.time_s(),
                100.0 * static_cast<double>(run.sim.step_number()) / static_cast<double>(steps));
  run.context.log.info(line);
}
}  // namespace

CaseResult run_case(const Case& c, const RunOptions& options, Context& context) {
  check_case(c);
  const double dt = c.time_step_s > 0 ? c.time_step_s : choose_time_step(c);
  CaseRun run(c, options, context, dt);
  const std::int64_t steps = static_cast<std::int64_t>(std::ceil(c.duration_s / dt * (1 - 1e-12)));
  if (!options.checkpoint.empty() && std::filesystem::exists(options.checkpoint))
    resume(run, steps);
  else
    fill_regions(run);
  const std::int64_t until = options.until_s > 0 ? static_cast<std::int64_t>(std::ceil(options.until_s / dt * (1 - 1e-12))) : steps;
  const std::int64_t last = std::min(steps, std::max(until, run.sim.step_number()));
  Keeper keeper(run, last);
  while (run.sim.step_number() < last) {
    if (run.sim.step_number() % kClockEvery == 0) keeper.look();
    rain_and_hand_over(run);
    observe(run);
    run.result.particle_steps += static_cast<double>(run.sim.grain_count());
    run.sim.step();
    watch_speed(run);
    count_crossings(run);
    if (run.sim.step_number() % kOutflowEvery == 0) remove_outside(run);
  }
  run.result.complete = last == steps;
  const bool keep = options.keep_checkpoint || !run.result.complete;
  // Before the last look: a run that goes on from here has not had it.
  if (!options.checkpoint.empty() && keep) save_checkpoint(run, options.checkpoint);
  const std::int64_t pictures_before = run.pictures;
  observe(run);
  if (run.c.pictures.every_s > 0 && run.options.on_picture && run.pictures == pictures_before) take_picture(run);  // the end is always shown
  finish_result(run);
  run.result.wall_clock_s = keeper.elapsed_s();
  if (options.profile) log_profile(run);
  if (!options.checkpoint.empty() && !keep) std::filesystem::remove(options.checkpoint);
  return std::move(run.result);
}
}  // namespace venato::dem
