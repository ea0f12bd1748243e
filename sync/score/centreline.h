#pragma once
#include <vector>
#include "sync/score/score.h"
namespace venato::sync {

/// Centre lines of a vein mask as short straight links between neighbouring skeleton pixels, sub-pixel across the vein.
struct CentreLink {
  Point from_m, to_m;
  double length_m = 0;  ///< along the line: the pixel step, so that lengths add up whatever the sub-pixel correction does
  double width_m = 0;   ///< of the vein there, edge to edge across it
};
/// Skeleton, spurs not longer than the vein is wide cut off, every point moved to the middle between the two edges across the vein.
/// Links where the vein is narrower than min_width_m are left out.
std::vector<CentreLink> centre_links(const graphics::Raster8& mask, double min_width_m);

/// For every sample (sample_step_m apart) of `lines`: the nearest crossing of its normal with a link of `partners` whose direction agrees within
/// direction_tolerance_rad, at most search_m away.
struct NormalResidual {
  Point at_m;
  double signed_distance_m = 0, length_m = 0;
  bool matched = false;
  Point normal = Point::UnitX();  ///< of the line there, towards +x (+y for lines along x): what the distance is along
  double width_m = 0;             ///< of the line's vein there
};
std::vector<NormalResidual> normal_residuals(const std::vector<CentreLink>& lines, const std::vector<CentreLink>& partners,
                                             const ScoreConfig& config);
}  // namespace venato::sync
