#pragma once
/// Inclined wall: a plate with powder on it is tilted until the powder slides or rolls off (seed paper, section 4).
#include "dem/rigs/rig_api.h"
namespace venato::dem::rigs::inclined_wall {
RigDescriptor descriptor();

struct Config {
  std::size_t wall = 0;             ///< the plate: a plane that turns
  double from_s = 0, to_s = 0;      ///< powder at rest at from_s; tilted until to_s
  double frame_every_s = 0.01;
  double moved_m = 0;               ///< a grain counts as off when it has moved so far along the plate; 0 = one mean grain
  std::size_t plan = 0;
};
void read(ObjectReader& r, Case& c, Config& config);

inline constexpr int kStrips = 6;
/// Share by mass of the grains of the first frame that are off, per frame; [strip][frame], strips of equal grain number along the plate's axis of
/// rotation, last entry all grains together. Grains that left the case count as off.
std::vector<std::vector<double>> share_off(const std::vector<Snapshot>& frames, const Case& c, const Config& config);
/// Tilt of the plate against the horizontal at time t [deg].
double tilt_deg(const Case& c, const Config& config, double time_s);
/// Angle at which `share` is first passed, linear between frames; NaN when it never is.
double angle_at(const std::vector<double>& angle_deg, const std::vector<double>& share_off, double share);
RigResult measure(const Config& config, const Case& c, const CaseResult& r);
}  // namespace venato::dem::rigs::inclined_wall
