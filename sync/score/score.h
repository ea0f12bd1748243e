#pragma once
#include <map>
#include <string>
#include <vector>
#include "graphics/raster/raster.h"
#include "sync/transform/transform.h"
namespace venato::sync {

/// How well print veins and body veins line up (registration_print.md 2.1). Both masks in the green frame, same pitch, 0/255.
struct Metrics {
  double centreline_median_m = 0, centreline_p95_m = 0,
         centreline_offset_m = 0, centreline_max_m = 0;  ///< along the vein normal, on matched length; NaN if nothing matched
  double matched_length = 0;                        ///< 0..1 of the print's centre-line length
  double missing_length_m = 0, extra_length_m = 0;  ///< body vein without print; print without body
  double boundary_f1_1mm = 0, boundary_f1_2mm = 0, boundary_f1_3mm = 0;
  double dice = 0, iou = 0, cl_dice = 0;
  double hd95_m = 0, assd_m = 0;
  double body_length_m = 0, print_length_m = 0;     ///< centre-line length that was scored
  double area_error = 0;                            ///< (print area - body area) / body area; NaN without body veins
  double body_width_m = 0, print_width_m = 0;       ///< median local vein width, by length; NaN without veins
  double direction_coherence = 0;                   ///< -1..1, see direction_coherence(); NaN without overlap
};
struct ScoreConfig {
  double search_m = 0.015, min_width_m = 0.0015, direction_tolerance_rad = 0.5236, sample_step_m = 0.0005;
};
/// \throws UsageError unless both masks have one channel, the same size and the same positive pitch
void check_masks(const graphics::Raster8& body, const graphics::Raster8& print);
Metrics score_masks(const graphics::Raster8& body, const graphics::Raster8& print, const ScoreConfig& config = {});
/// Residual per centre-line sample (print onto body), for the misfit map. Positive: the body ridge lies towards +x of the print (towards +y for veins
/// along x); NaN where unmatched.
struct ResidualSample {
  double x_m, y_m, signed_distance_m;
  bool matched;
};
std::vector<ResidualSample> centreline_residuals(const graphics::Raster8& body, const graphics::Raster8& print, const ScoreConfig& config = {});

/// Zhang-Suen skeleton of a 0/255 mask without staircases: one pixel thin, 8-connected (own: OpenCV's lives in contrib, which would pull hundreds of
/// packages).
graphics::Raster8 skeleton(const graphics::Raster8& mask);

/// Print vein mask seen on the slab: mask(print_from_green(p)) on the green grid.
graphics::Raster8 mask_on_green(const graphics::RasterF& print_fraction, const Transform& print_from_green, int width, int height, double pitch_m,
                                float threshold = 0.5f);
}  // namespace venato::sync
