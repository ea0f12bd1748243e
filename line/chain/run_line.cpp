#include "line/chain/run_line.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "line/chain/check_line.h"
#include "line/chain/run_folder.h"
#include "line/report/report.h"
namespace venato::line {
namespace {
// Output files of a run are some hundred bytes per pixel of the print in the worst case (no compression gain): refuse to start on a disk that cannot
// hold them.
constexpr double kPrintBytesPerInk = 1.2;

class Clock {
 public:
  explicit Clock(std::vector<std::pair<std::string, double>>& out) : out_(out) {}
  void lap(const std::string& phase) {
    const auto now = std::chrono::steady_clock::now();
    out_.emplace_back(phase, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  std::vector<std::pair<std::string, double>>& out_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

double expected_output_bytes(const LineConfig& c) {
  const auto size = green_size(c.basics);
  const double per_metre = c.graphic.print_dpi / 0.0254;
  const double print = size.width_m * size.length_m * per_metre * per_metre * static_cast<double>(graphic_inks(c).inks.size()) * kPrintBytesPerInk;
  // Separated inks of stone graphics shrink to a tenth or less with deflate; the grey files hold the same data once more.
  return 2 * print / 10 + 8.0 * static_cast<double>(c.basics.grid.columns()) * c.basics.grid.nz + 64e6;
}

std::vector<Operator> best_operators(const std::vector<StageOperator>& list) {
  std::vector<Operator> out;
  for (const auto& s : list) out.push_back(s.op);
  return out;
}

void obtain_all(const LineConfig& c, LineRun& run, Context& context) {
  int cached = 0;
  for (const auto& stage : c.chain) {
    if (context.stop_requested()) throw Interrupted("stopped before " + stage.stage.name);
    auto op = obtain_operator(c, stage, context);
    cached += op.cached;
    if (!op.cached) {
      char text[160];
      std::snprintf(text, sizeof text, "%-16s %7.2f s  operator by particle simulation", stage.stage.name.c_str(), op.wall_s);
      context.log.info(text);
    }
    for (const auto& w : op.op.warnings) {
      run.warnings.push_back(stage.stage.name + ": " + w);
      context.log.warn(run.warnings.back());
    }
    run.operators.push_back(std::move(op));
  }
  if (cached > 0)
    context.log.info("operators came from the store: " + std::to_string(cached) + " of " + std::to_string(c.chain.size()) + " (" +
                     context.store.root().string() + ")");
}

void check_slab_mass(const ChainResult& chain) {
  check_mass_book("the whole line (feed commands against slab)", chain.commands_mass_kg, chain.slab_mass_kg);
}
}  // namespace

std::string run_summary(const LineRun& run) {
  const auto line = [](const char* name, const sync::Metrics& m) {
    char text[200];
    std::snprintf(text, sizeof text, "%-15s centre line median %6.2f mm  P95 %6.2f mm  matched %5.1f %%  F1@2mm %.3f\n", name,
                  m.centreline_median_m * 1e3, m.centreline_p95_m * 1e3, m.matched_length * 100, m.boundary_f1_2mm);
    return std::string(text);
  };
  const auto& s = run.sync;
  return line("before", s.before) + (s.after ? line("after", *s.after) : std::string("after           none: registration failed\n")) +
         line("best reachable", s.best);
}

RunOutcome run_line(const LineConfig& config, const std::filesystem::path& out, Context& context) {
  check_line(config);
  context.seed = config.basics.seed;
  RunFolder folder(out);
  require_free_space(out, static_cast<std::uintmax_t>(expected_output_bytes(config)), "the run folder");
  LineRun run;
  Clock clock(run.timing_s);

  const auto design = load_design(config);
  std::vector<std::string> powders;
  for (const auto& p : config.basics.powders) powders.push_back(p.name);
  run.plan = graphics::plan_veins(design, config.design.plan, powders, config.basics.body_powder, config.basics.vein_powder);
  const auto commands = config.chain.front().stage.plan_commands(run.plan, config.basics);
  clock.lap("plan");
  obtain_all(config, run, context);
  clock.lap("operators");

  const auto operators = best_operators(run.operators);
  run.jitter = JitterField(config.belt_jitter, config.basics.grid.ny * config.basics.grid.pitch_m, config.basics.seed);
  ApplyOptions options;
  options.log_stages = true;
  run.chain = apply_chain(config, config.basics, operators, commands, run.jitter, options, context);
  check_slab_mass(run.chain);
  run.vein_map = look_at_slab(config.basics, run.slab(), config.vein_map.polish_depth_m, context.threads);
  clock.lap("slab");
  if (const auto error = vein_standard_error(config, operators, commands, run.jitter, context); !error.empty())
    run.vein_map.std_error = resample_to(error, run.vein_map.fraction.width, run.vein_map.fraction.height, run.vein_map.fraction.pitch_m);
  run.top_bottom_offset_m = top_bottom_offset(config.basics, run.slab(), context.threads);
  clock.lap("error bars");

  const auto layers = load_graphic(config, context.threads);
  const auto coarse = coarse_basics(config, config.vein_map.coarse_pitch_m);
  run.layer_shift_m = layer_shifts(config, coarse, operators, commands, context);
  const double thickness = sample_bilinear(run.slab().thickness_m, green_size(config.basics).width_m / 2, green_size(config.basics).length_m / 2, 0);
  const auto exact = make_exact_map(config, run.slab(), run.jitter, run.layer_shift_m, zeta_at_depth(config.vein_map.polish_depth_m, thickness));
  run.graphic = graphic_use(config, layers);
  run.sync = synchronise(config, run.vein_map, layers, exact, context);
  if (!run.sync.registration.success)
    run.warnings.push_back("registration failed: " + run.sync.registration.reason + "; the print files are as designed, not synchronised");
  clock.lap("registration");

  const auto& staging = folder.staging();
  write_mask_files(staging / "masks", config, run, layers, {}, context);
  clock.lap("masks");
  write_vein_map(staging / "vein_map.tif", run.vein_map, context.threads);
  write_figures(staging, config, run, design, flatten_layers(layers, false));
  write_run_h5(staging / "run.h5", config, run);
  write_score_json(staging / "score.json", config, run.sync);
  clock.lap("files");
  write_run_json(staging / "run.json", config, run, context);
  write_report(staging);
  folder.publish();
  return {run.sync.registration.success, run.sync.registration.reason, run_summary(run)};
}
}  // namespace venato::line
