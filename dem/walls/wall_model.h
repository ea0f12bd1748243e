#pragma once
/// A wall as the engine uses it: shape in its own frame (as drawn, time 0), broad phase for its triangles, and its pose at the current step.
/// Triangles are binned once in the wall's own frame and grains are carried into it, so moving meshes never need rebinning.
#include <vector>

#include "dem/walls/motion.h"
#include "dem/walls/nearest.h"

namespace venato::dem {

/// Which triangles may be nearer than `reach` to a point: uniform bins over the mesh, each triangle entered where its inflated bounds go.
class TriangleBins {
 public:
  void build(const std::vector<Triangle>& triangles, double reach);
  double reach() const { return reach_; }
  /// Indices of candidate triangles, ascending; empty range outside the mesh.
  std::pair<const int*, const int*> near(const Vec3& p) const;

 private:
  double reach_ = 0, cell_ = 1;
  Vec3 low_ = Vec3::Zero();
  int n_[3] = {0, 0, 0};
  std::vector<int> start_, item_;
};

struct WallModel {
  Wall wall;
  std::vector<Triangle> triangles;  ///< of a mesh
  TriangleBins bins;
  WallPose pose, pose_before, pose_at_build;
  Vec3 step_velocity_m_s = Vec3::Zero();  ///< offset change of the last step / dt: the wall's half-step velocity
  double reach_m = 0;                     ///< farthest point of the shape from the rotation centre (infinite for a tilting plane)
  double swing_m = 0;                     ///< farthest vibration excursion: widens the broad phase instead of forcing list rebuilds
  double listed_way_m = 0;                ///< how far the wall may have moved since the list was built before the list is made anew
  bool endless = false;                   ///< a plane that turns about an axis other than its normal: always a candidate
  bool is_mesh() const { return !triangles.empty(); }
  bool present(double time_s) const { return time_s >= wall.present.on_s && time_s < wall.present.off_s; }

  Vec3 into_wall_frame(const Vec3& p) const;  ///< of the current pose
  Vec3 direction_to_world(const Vec3& d) const;
  Vec3 point_to_world(const Vec3& p) const;
  /// Velocity of the wall's surface at a point on it; the belt's surface velocity counts only along the surface (normal given).
  Vec3 velocity_at(const Vec3& point_world, const Vec3& normal_world) const;
};

/// \throws UsageError naming the wall: zero normal, empty mesh, negative radius, non-finite numbers …
WallModel make_wall(const Wall& wall);
/// Touches of a sphere with any shape, in the wall's frame; `first, last` are the candidate triangles of a mesh.
MeshTouches touch_wall(const WallModel& w, const Vec3& centre_wall_frame, double radius, const int* first, const int* last);
}  // namespace venato::dem
