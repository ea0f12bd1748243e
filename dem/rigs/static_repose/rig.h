#pragma once
/// Static angle of repose: the heap that a lifted cylinder leaves on a plate (seed paper, figure 3).
#include "dem/rigs/rig_api.h"
namespace venato::dem::rigs::static_repose {
RigDescriptor descriptor();

struct Config {
  double floor_z_m = 0;                   ///< height of the plate
  int wedges = 6;                         ///< error bars come from the differences between them
  double fit_from = 0.15, fit_to = 0.80;  ///< the flank: between these shares of the apex height
  double ring_width_m = 0;                ///< of the profile; 0 = one mean grain (by volume)
};
void read(ObjectReader& r, Config& c);

/// Profile of a heap about its own axis (mean x, y of the grains by volume): the heap seen from above (height of the highest sphere at each point, the
/// plate's where there is none), mean over rings.
struct Profile {
  std::vector<double> radius_m;                     ///< middle of each ring
  std::vector<double> height_m;                     ///< mean over the ring
  std::vector<std::vector<double>> wedge_height_m;  ///< [wedge][ring]
  double grain_m = 0;                               ///< diameter of the mean grain volume
};
Profile heap_profile(const std::vector<GrainRecord>& grains, const Config& c);
/// Angle [deg] of a straight line through the flank of a profile: from the outermost ring that reaches `fit_to` of the apex to the first below
/// `fit_from`. NaN with fewer than three rings. `rms_m` (may be null): deviation from the line.
double flank_angle_deg(const std::vector<double>& radius_m, const std::vector<double>& height_m, const Config& c, double* rms_m = nullptr,
                       double* foot_m = nullptr);
RigResult measure(const Config& config, const Case& c, const CaseResult& r);
}  // namespace venato::dem::rigs::static_repose
