#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "graphics/graphic.h"
#include "sync/command/inputs.h"
#include "sync/command/map_csv.h"
#include "sync/command/noise_floor.h"
#include "sync/command/score_text.h"
#include "sync/command/sync_command.h"
#include "sync/overlay/overlay.h"

namespace venato::sync {
namespace {

constexpr const char* kBeforeDefinition = "the graphic as it would be printed without synchronisation: its top-left corner on the slab's, unturned";
constexpr const char* kAfterDefinition = "the graphic moved by print_from_green (map.csv)";

const char* tone_text(graphics::VeinTone tone) { return tone == graphics::VeinTone::darker ? "darker" : "lighter"; }

void tell_input(const char* what, const SyncInput& input, Log& log) {
  char text[200];
  const auto& raster = input.fraction;
  std::snprintf(text, sizeof text, ": %.4f mm/px (%s), %.0f x %.0f mm, veins on %.1f %%", input.pitch_in_file_m * 1e3,
                input.camera            ? "rectified"
                : input.pitch_from_file ? "from the file"
                                        : "given",
                raster.width_m() * 1e3, raster.height_m() * 1e3, 100 * vein_share(raster, input.valid));
  log.info(std::string(what) + text + (input.is_fraction_map ? " (fractions)" : std::string(" (") + tone_text(input.tone) + " than the body)"));
}

void tell_camera(const SyncInput& input, Log& log) {
  if (!input.camera) return;
  const auto& view = input.camera->view;
  char text[240];
  std::snprintf(text, sizeof text, "camera: %.3f to %.3f mm/px on the slab, %.1f %% of it seen", view.finest_m_px * 1e3, view.coarsest_m_px * 1e3,
                100 * input.camera->visible);
  std::string all = text;
  if (view.marks > 4) {
    std::snprintf(text, sizeof text, "; %d marks, residual median %.3f mm, largest %.3f mm", view.marks, view.mark_median_m * 1e3,
                  view.mark_max_m * 1e3);
    all += text;
  } else if (view.marks == 4) {
    all += "; four marks leave no residual: a wrong one is not noticed, five or more are";
  }
  log.info(all);
}

/// No edge of a vein is where the picture ends.
graphics::RasterF nan_outside(graphics::RasterF fraction, const graphics::Raster8& valid) {
  for (std::size_t k = 0; k < valid.data.size(); ++k)
    if (!valid.data[k]) fraction.data[k] = std::numeric_limits<float>::quiet_NaN();
  return fraction;
}

std::string error_text(const Metrics& m) {
  char text[64];
  std::snprintf(text, sizeof text, "%.2f mm on %.0f %%", m.centreline_median_m * 1e3, 100 * m.matched_length);
  return text;
}

std::string lying_text(const Lying& l) {
  char text[160];
  std::snprintf(text, sizeof text,
                "the graphic lies turned by %d deg%s and %.2f deg more; the slab's top-left corner at %.1f, %.1f mm of the graphic", l.turn_deg,
                l.mirrored ? ", mirrored," : "", l.rotation_rad * 180 / M_PI, l.corner_m.x() * 1e3, l.corner_m.y() * 1e3);
  return text;
}

std::string stretch_text(const SlabStretch& s) {
  char text[160];
  std::snprintf(text, sizeof text, "slab against graphic: %+.2f %% along the belt (y), %+.2f %% across, shear %+.2f mm per m", s.along * 100,
                s.across * 100, s.shear * 1e3);
  return text;
}

void remove_stale(const std::filesystem::path& out) {
  // Results of an earlier, successful call must not stand beside a failure.
  for (const char* name : {"score.json", "map.csv", "overlay.png", "misfit.png", "visibility.png", "rectified.png"}) {
    std::error_code error;
    std::filesystem::remove(out / name, error);
  }
}

/// Two pictures without a vein between them have nothing to register; say so in the result like every other failure.
std::string no_veins_reason(const SyncInput& vein_map, const SyncInput& graphic) {
  for (const auto* input : {&vein_map, &graphic})
    if (!(vein_share(input->fraction, input->valid) > 0)) return "no veins found in " + input->file.filename().string();
  return "";
}

struct Registered {
  EvidencePair evidence;
  Registration registration;
};
constexpr double kGoodResidual_m = 0.0003;  // T4 of registration_print.md 1.5: a pair this consistent needs no second opinion

/// Every attempt has to pass the same gates. Of those that do, the one whose held-out blocks agree best (a plan made differently from the body's
/// veins still registers, but twists the map); when none does, the reasons of all are told.
Registered register_best(std::vector<EvidencePair> pairs, const RegistrationConfig& config, Context& context) {
  std::optional<Registered> best;
  std::string reasons;
  for (EvidencePair& pair : pairs) {
    Registration result = register_veins(pair.green, pair.print, config, std::nullopt, context);
    reasons += (reasons.empty() ? "" : "; ") + (pairs.size() > 1 ? pair.name + ": " : std::string()) + result.reason;
    const bool good = result.success && result.internal_residual_m <= kGoodResidual_m;
    if (!best || (result.success && (!best->registration.success || result.internal_residual_m < best->registration.internal_residual_m)))
      best = Registered{std::move(pair), std::move(result)};
    if (good) break;
  }
  if (!best->registration.success) best->registration.reason = reasons;
  return std::move(*best);
}

}  // namespace

int run_sync(const SyncOptions& options, Context& context) {
  if (!options.camera.empty() && options.vein_pitch_m)
    throw UsageError("--vein-pitch-mm: not together with --camera, whose file says the pitch (pitch_mm)");
  const SyncInput vein_map = options.camera.empty()
                                 ? load_input(options.vein_map, options.vein_pitch_m, "--vein-pitch-mm", options.plan, options.tone_given)
                                 : load_camera_input(options.vein_map, options.camera, options.plan, options.tone_given, context.threads);
  const SyncInput graphic = load_input(options.graphic, options.graphic_pitch_m, "--graphic-pitch-mm", options.plan, options.tone_given);
  make_output_folder(options.out);
  remove_stale(options.out);
  if (vein_map.camera) graphics::write_png(options.out / "rectified.png", vein_map.camera->picture);
  tell_camera(vein_map, context.log);
  tell_input("vein map", vein_map, context.log);
  tell_input("graphic", graphic, context.log);

  auto [evidence, registration] = register_best(evidence_pairs(vein_map, graphic), options.registration, context);
  if (const std::string reason = no_veins_reason(vein_map, graphic); registration.success && !reason.empty()) {
    registration.success = false;  // registered on lightness alone: there is no line whose error could be measured
    registration.reason = reason;
  }
  const graphics::Raster8 body = vein_mask(vein_map.fraction);
  const auto print_on_green = [&](const Transform& map) {
    graphics::Raster8 print = mask_on_green(graphic.fraction, map, body.width, body.height, body.pitch_m);
    keep_valid(print, vein_map.valid);  // what the camera did not see is neither right nor wrong
    return print;
  };

  ScoreReport report;
  report.before_definition = kBeforeDefinition;
  report.after_definition = kAfterDefinition;
  report.evidence = evidence.name;
  if (vein_map.camera) report.camera = CameraReport{vein_map.camera->view, vein_map.camera->visible};
  report.tolerance = options.zones.tolerance;
  report.best_reachable_definition = kNoiseFloorDefinition;
  const graphics::Raster8 before = print_on_green(Transform{});
  report.before = score_masks(body, before, options.score);
  report.body_edge = edge_widths(nan_outside(vein_map.fraction, vein_map.valid), centre_links(body, options.score.min_width_m));
  report.print_edge = edge_widths(graphic.fraction, centre_links(vein_mask(graphic.fraction), options.score.min_width_m));
  graphics::Raster8 after;
  OverlayTexts texts;
  if (registration.success) {
    after = print_on_green(registration.print_from_green);
    report.after = score_masks(body, after, options.score);
    report.zones = score_zones(body, after, options.score, options.zones);
    report.pose_only = score_masks(body, print_on_green(registration.pose_only), options.score);
    report.best_reachable = noise_floor(evidence, vein_map.fraction, registration, options.registration, options.score, context);
    if (!report.best_reachable) report.best_reachable_definition += "; not available: the slab's own copy did not pass the gates";
    texts.note =
        "median centre-line error on the matched share of the print: before " + error_text(*report.before) + ", after " + error_text(*report.after);
  } else {
    texts.left_title = "not registered: graphic as it came";
    texts.note = "not registered: " + registration.reason;
  }

  if (graphic.has_colours)
    if (const auto colours = print_colours(graphic.picture, graphic.fraction))
      report.visibility = visibility_report(body, before, registration.success ? &after : nullptr, *colours, context.threads, {}, options.score);
  graphics::write_png(options.out / "overlay.png", overlay_figure(body, before, after, texts));
  if (registration.success) {
    graphics::write_png(options.out / "misfit.png", misfit_figure(body, centreline_residuals(body, after, options.score)));
    write_text_atomically(options.out / "map.csv", map_csv_text(registration.print_from_green, registration.sigma_m, vein_map.fraction.width_m(),
                                                                vein_map.fraction.height_m()));
  }
  if (report.visibility && registration.success) graphics::write_png(options.out / "visibility.png", visibility_figure(report.visibility->after));
  write_text_atomically(options.out / "score.json", score_json_text(report, registration));
  if (registration.success) {
    context.log.info(lying_text(how_it_lies(registration.pose_only)));
    context.log.info(stretch_text(registration.stretch));
  }
  context.log.info(registration.success ? "registered; " + texts.note : texts.note);
  return registration.success ? 0 : 1;
}

}  // namespace venato::sync
