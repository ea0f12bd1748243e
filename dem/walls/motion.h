#pragma once
/// Where a moving wall is at time t and how fast its surface moves there.
#include "dem/case.h"

namespace venato::dem {

/// Rigid placement at one time: x(t) = centre + offset + turn * (x(0) - centre).
struct WallPose {
  Vec3 offset_m = Vec3::Zero();         ///< all translations together
  Vec3 steady_offset_m = Vec3::Zero();  ///< without the vibration (what neighbour lists must follow)
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  bool turned = false;  ///< false: `turn` is exactly the identity
};

/// Vibration: A sin(2 pi f t' + phase) - A sin(phase), t' since the last `on`. After `off` the wall finishes its swing: it stops at the first zero
/// of the offset at or after `off` (a real drive does not jump back by up to an amplitude), unless the next `on` comes first.
Vec3 vibration_offset(const WallMotion& m, double time_s);
WallPose wall_pose(const WallMotion& m, double time_s);

/// Largest distance any point of a sphere of `reach_m` around the rotation centre has moved between two poses, vibration left out [m].
double pose_distance(const WallMotion& m, const WallPose& a, const WallPose& b, double reach_m);
/// \throws UsageError naming the wall: non-finite numbers, unsorted track, amplitude without frequency …
void check_motion(const std::string& wall, const WallMotion& m);
}  // namespace venato::dem
