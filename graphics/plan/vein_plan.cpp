#include "graphics/plan/vein_plan.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "graphics/plan/background.h"
#include "graphics/raster/mask.h"
#include "graphics/raster/resample.h"
namespace venato::graphics {
namespace {
constexpr double kPlanPitch_m = 1e-3;     // dosing prongs are 5 mm apart: nothing finer can be laid
constexpr float kSoftEdge_px = 1.5f;      // a filled hole or a removed part goes with its soft edge
constexpr double kBackgroundRank = 0.85;  // veins may cover up to 85 % of a window before the background follows them

void check(const Raster8& design, const VeinPlanConfig& c) {
  if (!(design.pitch_m > 0)) throw UsageError("the design picture has no pitch (mm per pixel)");
  if (!(c.background_window_m > 0) || !(c.darkness_threshold > 0) || !(c.min_width_m > 0) || !(c.min_area_m2 >= 0) || !(c.smoothing_m >= 0))
    throw UsageError("vein plan: window, threshold and minimum width must be positive, minimum area and smoothing not negative");
}

/// Where the picture differs from its background by more than the threshold, in the direction of the veins' tone.
Raster8 threshold(const Raster8& design, const VeinPlanConfig& c) {
  RasterF light = lightness(design);
  if (c.tone == VeinTone::lighter)
    for (auto& v : light.data) v = 1 - v;
  const RasterF back = local_background(light, c.background_window_m, kBackgroundRank);
  const RasterF smooth = gaussian(light, c.smoothing_m / light.pitch_m);
  Raster8 mask(light.width, light.height, 1, light.pitch_m);
  for (std::size_t k = 0; k < mask.data.size(); ++k) mask.data[k] = back.data[k] - smooth.data[k] > c.darkness_threshold ? 255 : 0;
  return mask;
}

/// Places narrower than two sigma of the smoothing that went before are dropped: a smoothed line is that narrow only when its peak is less
/// than e^(1/2) = 1.65 times the threshold, that is, a hairline that just shows.
Raster8 without_hairlines(const Raster8& mask, double sigma_px) {
  const RasterF field = signed_distance(mask);
  Raster8 core(mask.width, mask.height, 1, mask.pitch_m);
  for (std::size_t k = 0; k < core.data.size(); ++k) core.data[k] = field.data[k] > sigma_px - 0.5 ? 255 : 0;  // half a pixel: centre off the axis
  const RasterF to_core = distance_to(core);
  Raster8 out = mask;
  for (std::size_t k = 0; k < out.data.size(); ++k)
    if (to_core.data[k] > sigma_px + 0.5) out.data[k] = 0;
  return out;
}

/// Signed distance [px] of the mask united with discs of `radius_px` along the centre lines of its narrow places. A centre-line pixel
/// within a disc's reach of a place where the disc fits is left alone: the spurs that thinning leaves in wide veins widen nothing.
RasterF widened(const Raster8& mask, double radius_px) {
  RasterF field = signed_distance(mask);
  Raster8 wide(mask.width, mask.height, 1, mask.pitch_m);
  for (std::size_t k = 0; k < wide.data.size(); ++k) wide.data[k] = field.data[k] >= radius_px ? 255 : 0;
  const RasterF to_wide = distance_to(wide);
  Raster8 narrow_line = thin(mask);
  for (std::size_t k = 0; k < narrow_line.data.size(); ++k)
    if (to_wide.data[k] <= radius_px) narrow_line.data[k] = 0;
  const RasterF to_line = distance_to(narrow_line);
  for (std::size_t k = 0; k < field.data.size(); ++k) field.data[k] = std::max(field.data[k], static_cast<float>(radius_px) - to_line.data[k]);
  return field;
}
/// Border pixels repeated outwards, so that centre lines run on over the border instead of ending short of it.
Raster8 padded(const Raster8& mask, int pad) {
  Raster8 out(mask.width + 2 * pad, mask.height + 2 * pad, 1, mask.pitch_m);
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i) out.at(i, j) = mask.at(std::clamp(i - pad, 0, mask.width - 1), std::clamp(j - pad, 0, mask.height - 1));
  return out;
}
Raster8 inside(const RasterF& field) {
  Raster8 mask(field.width, field.height, 1, field.pitch_m);
  for (std::size_t k = 0; k < mask.data.size(); ++k) mask.data[k] = field.data[k] > 0 ? 255 : 0;
  return mask;
}
}  // namespace

VeinPlan plan_veins(const Raster8& design_srgb, const VeinPlanConfig& config, const std::vector<std::string>& powders, int body_powder,
                    int vein_powder) {
  const int n = static_cast<int>(powders.size());
  VENATO_EXPECTS(design_srgb.channels == 1 || design_srgb.channels == 3);
  VENATO_EXPECTS(body_powder >= 0 && body_powder < n && vein_powder >= 0 && vein_powder < n && body_powder != vein_powder);
  check(design_srgb, config);
  const Raster8 design = shrink(design_srgb, std::max(1, static_cast<int>(kPlanPitch_m / design_srgb.pitch_m + 1e-6)));
  const double pixel_area = design.pitch_m * design.pitch_m, radius_px = config.min_width_m / design.pitch_m / 2;
  // A part smaller than min_area is the printer's. Judged as drawn, before widening: a hairline's darkest bits must not become veins.
  const Raster8 drawn = without_hairlines(threshold(design, config), config.smoothing_m / design.pitch_m);
  const int pad = 2 * static_cast<int>(std::ceil(radius_px + config.smoothing_m / design.pitch_m)) + 2;
  RasterF field = widened(padded(without_small_parts(drawn, config.min_area_m2 / pixel_area), pad), radius_px);
  field = crop(gaussian(field, config.smoothing_m / design.pitch_m), pad, pad, design.width, design.height);
  // A hole that a disc of the minimum width would fill cannot be kept open.
  const Raster8 open = inside(field), filled = without_small_holes(open, config.min_width_m * config.min_width_m / pixel_area);
  Raster8 hole = filled;
  for (std::size_t k = 0; k < hole.data.size(); ++k) hole.data[k] = filled.data[k] && !open.data[k] ? 255 : 0;
  const Raster8 kept = without_small_parts(filled, config.min_area_m2 / pixel_area);
  const RasterF to_kept = distance_to(kept), to_hole = distance_to(hole);
  VeinPlan plan;
  plan.powders = powders;
  plan.body_powder = body_powder;
  plan.fraction = RasterF(design.width, design.height, n, design.pitch_m);
  for (std::size_t k = 0; k < field.data.size(); ++k) {
    // Area coverage of a pixel by a straight edge at signed distance d: 1/2 + d, clamped.
    float v = std::clamp(field.data[k] + 0.5f, 0.0f, 1.0f);
    if (kept.data[k] && to_hole.data[k] < kSoftEdge_px) v = 1;
    if (!kept.data[k] && to_kept.data[k] > kSoftEdge_px) v = 0;
    plan.fraction.data[k * static_cast<std::size_t>(n) + static_cast<std::size_t>(vein_powder)] = v;
    plan.fraction.data[k * static_cast<std::size_t>(n) + static_cast<std::size_t>(body_powder)] = 1 - v;
  }
  return plan;
}
}  // namespace venato::graphics
