#pragma once
/// Nearest points of wall shapes, in the wall's own (undisplaced) frame.
#include <optional>
#include <vector>

#include "dem/case.h"

namespace venato::dem {

/// Nearest point of a triangle. Source: Ericson, Real-Time Collision Detection (2005), 5.1.5.
Vec3 nearest_on_triangle(const Triangle& t, const Vec3& p);

/// One place where a sphere meets a wall.
struct WallTouch {
  Vec3 point = Vec3::Zero();   ///< on the wall
  Vec3 normal = Vec3::Zero();  ///< unit, from the sphere's centre towards the wall (for a centre behind a plane: still into the wall)
  double distance = 0;         ///< [m] centre to wall, negative behind a plane
};
WallTouch touch_plane(const PlaneShape& s, const Vec3& centre);
/// Empty when the sphere is nowhere near the surface. Grains belong to one side: a centre up to one radius beyond the surface is pushed back.
std::optional<WallTouch> touch_cylinder(const CylinderShape& s, const Vec3& centre, double radius);

/// Keeps one touch per geometric feature: going from near to far, a touch is dropped when its point lies on a triangle that is already
/// at least as near. So coplanar and convex neighbours (with or without matching vertices: T-junctions) give one contact, concave corners two.
/// \param candidates  triangle indices into `triangles`; \return touches closer than `radius`, nearest first (at most `kMaxTouches`)
inline constexpr int kMaxTouches = 4;
struct MeshTouches {
  WallTouch touch[kMaxTouches];
  int count = 0;
};
MeshTouches touch_mesh(const std::vector<Triangle>& triangles, const int* first, const int* last, const Vec3& centre, double radius);
}  // namespace venato::dem
