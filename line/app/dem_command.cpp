#include <cstdio>

#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "dem/case_outputs/case_outputs.h"
#include "dem/case_reader.h"
#include "line/app/commands.h"
#include "line/chain/run_folder.h"
namespace venato::line::app {
namespace {
constexpr const char* kKind = "dem-case";
constexpr const char* kCodeVersion = "1";
}  // namespace

int dem_command(const Options& o, Context& context) {
  std::vector<Override> overrides;
  for (const auto& text : o.overrides) overrides.push_back(parse_override(text));
  ReadOutcome outcome;
  const auto c = dem::load_case(o.input, overrides, &outcome);
  const auto cost = dem::estimate_cost(c, context.threads);
  char text[200];
  std::snprintf(text, sizeof text, "%s: %.0f particles, %.0f steps, %.2e particle-steps, %.0f MiB, about %.0f s", c.name.c_str(), cost.particles,
                cost.steps, cost.particle_steps, cost.memory_bytes / 1048576.0, cost.seconds);
  context.log.info(text);
  context.seed = c.seed;
  RunFolder folder(o.out);

  // The checkpoint lives in the store under the case's content, so that the same command resumes it whatever OUT is.
  const auto key = store_key(kKind, outcome.resolved_json, {}, kCodeVersion);
  dem::RunOptions options;
  options.checkpoint = context.store.checkpoint_path(kKind, key);
  if (c.vtk_every_s > 0) options.vtk_folder = folder.staging() / "vtk";
  const auto result = dem::run_case(c, options, context);
  for (const auto& warning : result.warnings) context.log.warn(warning);
  dem::write_case_outputs(folder.staging(), c, result);
  write_text_atomically(folder.staging() / "case.json", outcome.resolved_json + "\n");
  folder.publish();
  context.store.drop_checkpoint(kKind, key);
  std::snprintf(text, sizeof text, "%s: %.3g particle-steps in %.1f s, mass in %.6g kg  out %.6g kg  left %.6g kg  lost %.6g kg", c.name.c_str(),
                result.particle_steps, result.wall_clock_s, result.mass_put_in_kg, result.mass_removed_kg, result.mass_left_kg,
                result.mass_lost_box_kg);
  context.log.info(text);
  return 0;
}
}  // namespace venato::line::app
