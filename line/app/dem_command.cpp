#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/progress_text.h"
#include "base/store/store.h"
#include "dem/case_outputs/case_outputs.h"
#include "dem/case_reader.h"
#include "dem/picture/picture.h"
#include "graphics/graphic.h"
#include "line/app/commands.h"
#include "line/app/dem_work.h"
#include "line/chain/run_folder.h"
namespace venato::line::app {
namespace {
constexpr const char* kCodeVersion = "2";
// Below that a second thread waits more than it works; on a busy machine, where threads wait for each other to be scheduled, by a factor of 100.
constexpr double kFewestGrainsPerThread = 1500;

template <class... Args>
std::string printed(const char* format, Args... args) {
  char text[512];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}

std::string cost_line(const dem::Case& c, const dem::CaseCost& cost, int threads) {
  return printed("%s: about %.0f grains, %.0f steps of %.3g us, %.2g particle-steps, %.0f MiB, about %s on %d thread%s", c.name.c_str(),
                 cost.particles, cost.steps, 1e6 * dem::choose_time_step(c), cost.particle_steps, std::max(1.0, cost.memory_bytes / 1048576.0),
                 duration_text(cost.seconds).c_str(), threads, threads == 1 ? "" : "s");
}

/// What happens to the state that an interrupted run of the same case left.
void treat_checkpoint(const Options& o, const dem::Case& c, DemWork& work, Log& log) {
  if (!work.has_checkpoint()) {
    if (o.resume) log.info(c.name + ": there is no checkpoint of this case, starting from the beginning");
    work.clear();  // frames that a run without a checkpoint left
  } else if (o.restart) {
    work.clear();
    log.info(c.name + ": the checkpoint of an earlier run is thrown away (--restart)");
  } else if (!o.resume) {
    throw UsageError("an earlier run of the case '" + c.name + "' was stopped before its end (" + work.checkpoint().string() +
                     "). Give --resume to go on from there or --restart to throw it away and begin anew");
  }
}

std::string end_line(const dem::Case& c, const dem::CaseResult& r) {
  return printed("%s: %.3g particle-steps, %s, mass in %.6g g  out %.6g g  left %.6g g  lost %.6g g", c.name.c_str(), r.particle_steps,
                 duration_text(r.wall_clock_s).c_str(), 1e3 * r.mass_put_in_kg, 1e3 * r.mass_removed_kg, 1e3 * r.mass_left_kg,
                 1e3 * r.mass_lost_box_kg);
}
}  // namespace

int dem_command(const Options& o, Context& context) {
  std::vector<Override> overrides;
  for (const auto& text : o.overrides) overrides.push_back(parse_override(text));
  ReadOutcome outcome;
  const auto c = dem::load_case(o.input, overrides, &outcome);
  if (o.threads == 0) {  // not asked for a number; results do not depend on it
    const double useful = std::max(1.0, std::floor(dem::estimate_cost(c, 1).particles / kFewestGrainsPerThread));
    context.threads = static_cast<int>(std::min<double>(context.threads, useful));
  }
  context.log.info(cost_line(c, dem::estimate_cost(c, context.threads), context.threads));
  context.seed = c.seed;

  // Kept in the store under the case's content, so that --resume finds it whatever OUT is.
  DemWork work(context.store, store_key("dem-case", outcome.resolved_json, {}, kCodeVersion), c.name);
  treat_checkpoint(o, c, work, context.log);
  RunFolder folder(o.out);
  dem::RunOptions options;
  options.checkpoint = work.checkpoint();
  options.keep_checkpoint = true;  // until OUT is complete
  options.until_s = o.until_s;
  options.profile = o.profile;
  if (o.until_s >= c.duration_s) context.log.info(printed("%s: --until %g s is not before its end at %g s", c.name.c_str(), o.until_s, c.duration_s));
  if (c.vtk_every_s > 0) options.vtk_folder = work.folder() / "vtk";
  if (c.pictures.every_s > 0) {
    const auto pictures = work.folder() / "pictures";
    make_output_folder(pictures);
    options.on_picture = [pictures](const dem::RgbImage& image, int frame, double) {
      graphics::Raster8 raster(image.width, image.height, 3, image.m_per_px);
      raster.data = image.rgb;
      graphics::write_png(pictures / printed("picture_%04d.png", frame), raster);
    };
  }
  const auto result = dem::run_case(c, options, context);  // says its warnings itself

  const auto report = dem::write_case_outputs(folder.staging(), c, result);
  for (const auto& warning : report.warnings) context.log.warn(c.name + ": " + warning);
  write_text_atomically(folder.staging() / "case.json", outcome.resolved_json + "\n");
  work.place("vtk", folder.staging() / "vtk");
  work.place("pictures", folder.staging() / "pictures");
  folder.publish();
  context.log.info(end_line(c, result));
  if (!o.quiet) std::fputs(dem::kpi_text(report.kpis).c_str(), stdout);
  if (!o.quiet) std::printf("results: %s\n", o.out.c_str());
  if (result.complete)
    work.clear();
  else
    context.log.info(printed("%s: stopped at t = %g s of %g s as asked; the same command with --resume goes on from here", c.name.c_str(),
                             result.end_time_s, c.duration_s));
  return 0;
}
}  // namespace venato::line::app
