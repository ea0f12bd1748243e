#pragma once
#include <vector>
#include "line/projection/grid_field.h"
#include "line/projection/open_stage.h"
namespace venato::line {

/// A segment with its unit normal, turned so that the net flow of the fields through it is positive, and the cumulated solid flux along it.
struct FluxProfile {
  Segment segment{};
  double length_m = 0, along_y = 0, along_z = 0, normal_y = 0, normal_z = 0;
  double net_m2_s = 0;                        ///< integral of phi u . n, back flow counted
  std::vector<double> cumulated;              ///< of the forward part, [0] = 0 … [n] = 1 at equal distances
  double position_at(double quantile) const;  ///< distance from the first end [m]
  double quantile_at(double distance_m) const;
  /// Signed distance of a point in front (> 0, downstream) of the segment's line, and where along the segment its foot lies.
  double ahead_m(double y_m, double z_m) const { return (y_m - segment.y0_m) * normal_y + (z_m - segment.z0_m) * normal_z; }
  double along_m(double y_m, double z_m) const { return (y_m - segment.y0_m) * along_y + (z_m - segment.z0_m) * along_z; }
};
/// Which side of the segment the powder is on that counts: the inlet is read just downstream of its line, the outlet just upstream, so that both may
/// lie on the border of the grid.
enum class SegmentRole { inlet, outlet };
/// \throws WorkError when nothing flows through it
FluxProfile flux_profile(const GridField& field, const Segment& segment, SegmentRole role);
}  // namespace venato::line
