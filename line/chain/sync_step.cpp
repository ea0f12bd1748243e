#include "line/chain/sync_step.h"

#include "graphics/plan/vein_plan.h"
namespace venato::line {
namespace {

/// Veins of the graphic, found with the plan's own rule; its lengths are those of the print frame.
graphics::RasterF print_veins(const LineConfig& c, const graphics::Raster8& srgb) {
  auto plan = c.design.plan;
  const double s = c.basics.print_from_design();
  plan.background_window_m *= s;
  plan.min_width_m *= s;
  plan.min_area_m2 *= s * s;
  plan.smoothing_m *= s;
  const auto veins = graphics::plan_veins(srgb, plan, {"body", "vein"}, 0, 1);
  graphics::RasterF out(veins.fraction.width, veins.fraction.height, 1, veins.fraction.pitch_m);
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i) out.at(i, j) = veins.fraction.at(i, j, 1);
  return out;
}
graphics::Raster8 veins_above(const graphics::RasterF& fraction, float threshold) {
  graphics::Raster8 out(fraction.width, fraction.height, 1, fraction.pitch_m);
  for (std::size_t k = 0; k < fraction.data.size(); ++k) out.data[k] = fraction.data[k] > threshold ? 255 : 0;
  return out;
}
}  // namespace

sync::Transform on_dried_slab(const sync::Transform& t, double scale) {
  // A (p/s + u(p/s)) + t = (A/s) (p + s u(p/s)) + t
  sync::Transform out = t;
  out.a /= scale;
  out.u.origin_m *= scale;
  out.u.spacing_m *= scale;
  for (auto& v : out.u.cx) v *= scale;
  for (auto& v : out.u.cy) v *= scale;
  return out;
}

SyncResult synchronise(const LineConfig& c, const graphics::VeinMap& vein_map, const std::vector<LoadedLayer>& layers, const ExactMap& exact,
                       Context& context) {
  SyncResult out;
  const float threshold = static_cast<float>(c.sync.threshold);
  const auto vein = graphics::vein_fraction(vein_map);
  const int width = vein.width, height = vein.height;
  const double pitch = vein.pitch_m;
  out.nominal.a *= 1 - c.basics.drying_shrinkage;
  const auto look = flatten_layers(layers, true);
  out.print_fraction = print_veins(c, look);

  sync::Evidence green, print;
  green.value = vein;
  print.value = out.print_fraction;
  out.registration = sync::register_veins(green, print, c.sync.registration, std::nullopt, context);

  out.body = veins_above(vein, threshold);
  out.print_before = sync::mask_on_green(out.print_fraction, out.nominal, width, height, pitch, threshold);
  const auto& used = out.registration.success ? out.registration.print_from_green : out.nominal;
  out.print_after = out.registration.success ? sync::mask_on_green(out.print_fraction, used, width, height, pitch, threshold) : out.print_before;
  out.print_best = exact_mask_on_green(out.print_fraction, exact, width, height, pitch, threshold);

  out.before = sync::score_masks(out.body, out.print_before, c.sync.score);
  if (out.registration.success) {
    out.after = sync::score_masks(out.body, out.print_after, c.sync.score);
    auto zones = c.sync.zones;
    zones.seed = c.basics.seed;
    out.zones = sync::score_zones(out.body, out.print_after, c.sync.score, zones);
  }
  out.best = sync::score_masks(out.body, out.print_best, c.sync.score);
  if (const auto colours = sync::print_colours(look, out.print_fraction))
    out.visibility = sync::visibility_report(out.body, out.print_before, out.registration.success ? &out.print_after : nullptr, *colours,
                                             context.threads, {}, c.sync.score);
  out.body_edge = sync::edge_widths(vein, sync::centre_links(out.body, c.sync.score.min_width_m));
  out.print_edge = sync::edge_widths(out.print_fraction, sync::centre_links(veins_above(out.print_fraction, threshold), c.sync.score.min_width_m));
  out.residuals_before = sync::centreline_residuals(out.body, out.print_before, c.sync.score);
  out.residuals_after = out.registration.success ? sync::centreline_residuals(out.body, out.print_after, c.sync.score) : out.residuals_before;
  out.residuals_best = sync::centreline_residuals(out.body, out.print_best, c.sync.score);
  out.error_before = compare_with_exact(out.nominal, exact, out.body);
  out.error_after = compare_with_exact(used, exact, out.body);
  return out;
}
}  // namespace venato::line
