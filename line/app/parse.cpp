#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "base/version.h"
#include "line/app/options.h"
namespace venato::line::app {
namespace {
constexpr int kUsage = 2;

void add_common(CLI::App& sub, Options& o) {
  sub.add_option("--threads", o.threads, "threads to use (default: all cores of this process); results do not depend on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  sub.add_flag("--quiet", o.quiet, "warnings and errors only");
  sub.add_flag("--json-log", o.json_log, "log and progress as one JSON object per line");
}
void add_out(CLI::App& sub, Options& o) { sub.add_option("-o,--out", o.out, "output folder (made when missing)")->required()->type_name("OUT"); }
void add_set(CLI::App& sub, Options& o) {
  sub.add_option("--set", o.overrides, "override one key of the config, e.g. --set /belt_speed_m_s=0.12; may be given again")
      ->type_name("/POINTER=VALUE")
      ->allow_extra_args(false);
}
}  // namespace

Parsed parse(int argc, const char* const* argv) {
  Parsed parsed;
  Options& o = parsed.options;
  CLI::App app{"Venato predicts where the veins of a full-body decorated ceramic slab end up and makes the inkjet print land on them.", "venato"};
  app.set_version_flag("--version", "venato " + version_string());
  app.require_subcommand(1);
  app.footer(
      "Examples:\n  venato validate configs/demo_slab.json\n  venato run configs/demo_slab.json -o out/demo\n  venato run configs/demo_slab.json -o "
      "out/fast --set /belt_speed_m_s=0.12\n"
      "Exit codes: 0 done, 1 the work failed, 2 wrong usage or config, 130 stopped (run again to resume).\nFinished operators are kept in "
      "$VENATO_STORE (default ~/.cache/venato).");

  auto* run = app.add_subcommand("run", "the whole line: commands, operators, slab, vein map, registration, score, masks, report");
  run->add_option("CONFIG", o.input, "line config (format venato-line)")->required();
  add_out(*run, o), add_set(*run, o), add_common(*run, o);
  run->footer(
      "Example:\n  venato run configs/demo_slab.json -o out/demo --threads 2\nExit 1 when the registration does not succeed; the report is written "
      "all the same and says why.");

  auto* validate = app.add_subcommand("validate", "all mistakes of a config at once, then what a run would cost");
  validate->add_option("CONFIG", o.input, "line config")->required();
  add_set(*validate, o), add_common(*validate, o);
  validate->footer("Example:\n  venato validate configs/demo_slab.json --set /chain/3/peak_pressure_mpa=45");

  auto* describe = app.add_subcommand("describe-config", "reference of every key of a line config or a DEM case");
  describe->add_flag("--schema", o.schema, "as JSON Schema for editors");
  describe->add_flag("--dem", o.dem, "of a DEM case instead of a line");
  describe->footer("Example:\n  venato describe-config --schema > venato-line.schema.json\n  venato describe-config --dem");

  auto* dem = app.add_subcommand("dem", "one particle simulation (slice, rig, hopper)");
  dem->add_option("CASE", o.input, "case file (format venato-dem)")->required();
  add_out(*dem, o), add_set(*dem, o), add_common(*dem, o);
  auto* go_on = dem->add_flag("--resume", o.resume, "go on from where an earlier run of this case was stopped (bit for bit); without one, start");
  dem->add_flag("--restart", o.restart, "throw away what an earlier run of this case left and begin anew")->excludes(go_on);
  dem->add_option("--until", o.until_s, "stop at this simulated time with results so far and a checkpoint; --resume goes on from it")
      ->check([](const std::string& text) {
        double value = 0;
        return CLI::detail::lexical_cast(text, value) && value > 0 ? std::string() : "'" + text + "' is not a time > 0 [s]";
      })
      ->type_name("TIME_S");
  dem->add_flag("--profile", o.profile, "show how the time is spent, by phase of the step");
  dem->footer(
      "Examples:\n  venato dem configs/dem/lifted_cylinder.json -o out/heap\n  venato dem configs/dem/lifted_cylinder.json -o out/heap --until 0.4\n"
      "  venato dem configs/dem/lifted_cylinder.json -o out/heap --resume\n"
      "Writes result.h5, kpi.csv, series and counters as CSV, plots (SVG) and, when the case asks for them, pictures (PNG) and ParaView files\n"
      "(open vtk/grains.pvd). A stopped run (Ctrl-C, kill, --until) leaves a checkpoint in the store; the same case then needs --resume or "
      "--restart.");

  auto* sync = app.add_subcommand("sync", "registration and score for any two pictures, e.g. a camera picture of a pressed slab (--camera)");
  sync->add_option("--vein-map", o.vein_map, "vein map or picture of the slab (TIFF, PNG, JPEG)")->required()->type_name("V");
  sync->add_option("--graphic", o.graphic, "the inkjet graphic")->required()->type_name("G");
  auto* camera = sync->add_option("--camera", o.camera, "the vein map is a camera's picture: marks or homography, lens, size of the slab (JSON)");
  camera->type_name("FILE");
  sync->add_option("--vein-pitch-mm", o.vein_pitch_mm, "pixel size of the vein map (default: dpi in the file)")
      ->check(CLI::Range(0.001, 1000.0))
      ->excludes(camera)
      ->type_name("P");
  sync->add_option("--graphic-pitch-mm", o.graphic_pitch_mm, "pixel size of the graphic (default: dpi in the file)")
      ->check(CLI::Range(0.001, 1000.0))
      ->type_name("P");
  sync->add_option("--turns", o.turns, "turns of the graphic to try: none (default), half (0, 180 deg) or quarter (0, 90, 180, 270 deg)")
      ->check(CLI::IsMember({"none", "half", "quarter"}))
      ->type_name("KIND");
  sync->add_flag("--mirrored", o.mirrored, "the graphic may lie mirrored on the slab, too");
  sync->add_option("--max-rotation-deg", o.max_rotation_deg, "how far the slab may lie turned besides (default 3)")
      ->check(CLI::Range(0.1, 10.0))
      ->type_name("A");
  add_out(*sync, o), add_common(*sync, o);
  sync->footer(
      "Example:\n  venato sync --vein-map out/demo/vein_map.tif --graphic graphic.png --graphic-pitch-mm 1 -o out/sync\n"
      "  venato sync --vein-map camera.png --camera configs/camera/overhead.json --graphic graphic.png --graphic-pitch-mm 1 -o out/sync\n"
      "The camera file is explained in graphics/rectify/README.md; rectified.png shows the picture in the slab's frame.\n"
      "The slab may be a portion of a larger graphic, anywhere in it. Exit 1 when the pictures do not belong together.");

  auto* masks = app.add_subcommand("masks", "printer files of a finished run again: another resolution, compression or polarity, nothing simulated");
  masks->add_option("RUN", o.input, "run folder")->required();
  masks->add_option("--dpi", o.dpi, "of the print files (default: the run's print_dpi)")->check(CLI::Range(10.0, 1200.0))->type_name("DPI");
  masks->add_option("--compression", o.compression, "deflate (default), lzw, packbits or none")
      ->check(CLI::IsMember({"deflate", "lzw", "packbits", "none"}))
      ->type_name("KIND");
  const auto polarity = CLI::IsMember({"zero-is-no-ink", "zero-is-full-ink"});
  masks->add_option("--print-polarity", o.print_polarity, "of print.tif: zero-is-no-ink (default) or zero-is-full-ink")
      ->check(polarity)
      ->type_name("P");
  masks->add_option("--ink-polarity", o.ink_polarity, "of the grey file of each ink: zero-is-full-ink (default) or zero-is-no-ink")
      ->check(polarity)
      ->type_name("P");
  masks->add_flag("--powders-at-print-resolution", o.powders_at_print_resolution, "powder masks at the print's dpi instead of the vein map's pitch");
  add_out(*masks, o), add_common(*masks, o);
  masks->footer(
      "Example:\n  venato masks out/demo -o out/demo_360 --dpi 360\nAll files appear together at the end or not at all; the disk is checked first. "
      "The graphic's pictures must be where and what they\nwere when the run was made.");

  auto* report = app.add_subcommand("report", "rebuilds report.html of a finished run");
  report->add_option("RUN", o.input, "run folder")->required();
  add_common(*report, o);
  report->footer("Example:\n  venato report out/demo");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    parsed.finished = true;
    if (e.get_exit_code() == 0) {
      app.exit(e, std::cout, std::cerr);
      return parsed;
    }
    std::cerr << "venato: " << e.what() << "\nRun with --help for more information.\n";
    parsed.exit_code = kUsage;
    return parsed;
  }
  o.command = app.get_subcommands().front()->get_name();
  return parsed;
}
}  // namespace venato::line::app
