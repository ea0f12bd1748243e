#pragma once
/// Dynamic angle of repose: slope of the free surface in a rotating drum, at one or several speeds one after the other (seed paper, figure 4).
#include "dem/rigs/rig_api.h"
namespace venato::dem::rigs::dynamic_repose {
RigDescriptor descriptor();

struct Plateau {
  double speed_rad_s = 0;          ///< of the drum (its sign does not matter)
  double from_s = 0, to_s = 0;     ///< steady part: frames of this window count
  std::size_t plan = 0;            ///< its snapshot plan
};
struct Config {
  int axis = 0;                    ///< of the drum: 0 = x (the plane seen is y, z), 1 = y (x, z)
  double centre_m[2] = {0, 0};     ///< of the drum in that plane (horizontal, z)
  double radius_m = 0;
  double frame_every_s = 0.01;
  double central = 0.5;            ///< the slope is fitted over |horizontal| <= central * radius
  std::vector<Plateau> plateaus;
};
void read(ObjectReader& r, Case& c, Config& config);

/// Free surface: in each column of about one mean grain, the height at which the solid fraction (mean over frames) falls through half of that of the
/// filled part, interpolated between cells. NaN where a column has none.
struct Surface {
  std::vector<double> across_m, height_m;   ///< relative to the drum's centre
};
Surface free_surface(const std::vector<const Snapshot*>& frames, const Config& config, double grain_m);
/// Slope of the central part against the horizontal [deg], signed (rising to the right > 0); NaN with fewer than four columns.
double surface_angle_deg(const Surface& s, const Config& config, double* rms_m = nullptr);
RigResult measure(const Config& config, const Case& c, const CaseResult& r);
}  // namespace venato::dem::rigs::dynamic_repose
