#include "dem/walls/wall_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace venato::dem {
namespace {
constexpr double kMostBins = 4e6;
}

void TriangleBins::build(const std::vector<Triangle>& triangles, double reach) {
  reach_ = reach;
  low_ = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low_, size = Vec3::Zero();
  for (const Triangle& t : triangles) {
    const Vec3 a = t.a.cwiseMin(t.b).cwiseMin(t.c), b = t.a.cwiseMax(t.b).cwiseMax(t.c);
    low_ = low_.cwiseMin(a), high = high.cwiseMax(b), size += b - a;
  }
  low_.array() -= reach, high.array() += reach;
  // Bins about as large as the triangles, never much smaller than the reach.
  cell_ = std::max(4 * reach, size.maxCoeff() / static_cast<double>(std::max<std::size_t>(triangles.size(), 1)) / 2);
  while (((high - low_) / cell_).array().ceil().max(1.0).prod() > kMostBins) cell_ *= 1.5;
  for (int a = 0; a < 3; ++a) n_[a] = std::max(1, static_cast<int>(std::ceil((high[a] - low_[a]) / cell_)));
  const std::size_t cells = static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]) * static_cast<std::size_t>(n_[2]);
  std::vector<std::vector<int>> bin(cells);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const Triangle& t = triangles[k];
    const Vec3 a = t.a.cwiseMin(t.b).cwiseMin(t.c).array() - reach, b = t.a.cwiseMax(t.b).cwiseMax(t.c).array() + reach;
    int lo[3], hi[3];
    for (int d = 0; d < 3; ++d) {
      lo[d] = std::clamp(static_cast<int>(std::floor((a[d] - low_[d]) / cell_)), 0, n_[d] - 1);
      hi[d] = std::clamp(static_cast<int>(std::floor((b[d] - low_[d]) / cell_)), 0, n_[d] - 1);
    }
    const double far = reach + 0.5 * std::sqrt(3.0) * cell_ * (1 + 1e-9);
    for (int z = lo[2]; z <= hi[2]; ++z)
      for (int y = lo[1]; y <= hi[1]; ++y)
        for (int x = lo[0]; x <= hi[0]; ++x) {
          const Vec3 middle = low_ + cell_ * Vec3(x + 0.5, y + 0.5, z + 0.5);
          if ((nearest_on_triangle(t, middle) - middle).norm() > far) continue;  // sloping triangles leave most of their bounding box
          bin[(static_cast<std::size_t>(z) * static_cast<std::size_t>(n_[1]) + static_cast<std::size_t>(y)) * static_cast<std::size_t>(n_[0]) +
              static_cast<std::size_t>(x)]
              .push_back(static_cast<int>(k));
        }
  }
  start_.assign(1, 0);
  item_.clear();
  for (const auto& b : bin) {
    item_.insert(item_.end(), b.begin(), b.end());
    start_.push_back(static_cast<int>(item_.size()));
  }
}

std::pair<const int*, const int*> TriangleBins::near(const Vec3& p) const {
  std::size_t k[3];
  for (int a = 0; a < 3; ++a) {
    const double q = (p[a] - low_[a]) / cell_;
    if (!(q >= 0 && q < n_[a])) return {nullptr, nullptr};
    k[a] = static_cast<std::size_t>(q);
  }
  const std::size_t bin = (k[2] * static_cast<std::size_t>(n_[1]) + k[1]) * static_cast<std::size_t>(n_[0]) + k[0];
  return {item_.data() + start_[bin], item_.data() + start_[bin + 1]};
}

Vec3 WallModel::into_wall_frame(const Vec3& p) const {
  if (!pose.turned) return p - pose.offset_m;
  const Vec3& c = wall.motion.rotation_centre;
  return c + pose.turn.transpose() * (p - c - pose.offset_m);
}
Vec3 WallModel::direction_to_world(const Vec3& d) const { return pose.turned ? Vec3(pose.turn * d) : d; }
Vec3 WallModel::point_to_world(const Vec3& p) const {
  if (!pose.turned) return p + pose.offset_m;
  const Vec3& c = wall.motion.rotation_centre;
  return c + pose.offset_m + pose.turn * (p - c);
}
Vec3 WallModel::velocity_at(const Vec3& point, const Vec3& normal) const {
  const WallMotion& m = wall.motion;
  Vec3 v = step_velocity_m_s;
  if (pose.turned) v += m.rotation_rad_s.cross(point - m.rotation_centre - pose.offset_m);
  const Vec3& belt = m.surface_velocity_m_s;
  if (!belt.isZero(0)) v += belt - belt.dot(normal) * normal;
  return v;
}

WallModel make_wall(const Wall& wall) {
  auto fail = [&](const std::string& why) { throw UsageError("wall '" + wall.name + "': " + why); };
  check_motion(wall.name, wall.motion);
  WallModel w;
  w.wall = wall;
  const Vec3& centre = wall.motion.rotation_centre;
  const double rate = wall.motion.rotation_rad_s.norm();
  const Vec3 spin_axis = rate > 0 ? Vec3(wall.motion.rotation_rad_s / rate) : Vec3(Vec3::Zero());
  if (auto* plane = std::get_if<PlaneShape>(&w.wall.shape)) {
    if (!(plane->normal.norm() > 0) || !plane->normal.allFinite() || !plane->point.allFinite())
      fail("a plane needs a finite point and a normal that is not zero");
    if (std::abs(plane->normal.norm() - 1) > 1e-12) plane->normal.normalize();
    w.endless = rate > 0 && plane->normal.cross(spin_axis).norm() > 1e-9;
  } else if (auto* cylinder = std::get_if<CylinderShape>(&w.wall.shape)) {
    if (!(cylinder->radius_m > 0 && cylinder->length_m > 0 && cylinder->axis.norm() > 0)) fail("a cylinder needs radius > 0, length > 0 and an axis");
    if (!cylinder->base.allFinite() || !cylinder->axis.allFinite()) fail("a cylinder needs finite numbers");
    if (std::abs(cylinder->axis.norm() - 1) > 1e-12) cylinder->axis.normalize();
    const Vec3 arm = cylinder->base - centre;
    const bool about_itself = rate > 0 && cylinder->axis.cross(spin_axis).norm() < 1e-9 && (arm - arm.dot(spin_axis) * spin_axis).norm() < 1e-9;
    w.reach_m = about_itself ? 0 : std::max(arm.norm(), (arm + cylinder->length_m * cylinder->axis).norm()) + cylinder->radius_m;
  } else {
    w.triangles = std::get<MeshShape>(w.wall.shape).triangles;
    if (w.triangles.empty()) fail("its mesh has no triangles");
    for (const Triangle& t : w.triangles) {
      if (!t.a.allFinite() || !t.b.allFinite() || !t.c.allFinite()) fail("its mesh has a corner that is not finite");
      for (const Vec3& p : {t.a, t.b, t.c}) w.reach_m = std::max(w.reach_m, (p - centre).norm());
    }
  }
  const WallMotion& m = w.wall.motion;
  if (m.vibration_hz > 0) w.swing_m = 2 * m.vibration_amplitude_m.norm();
  w.pose = w.pose_before = w.pose_at_build = wall_pose(m, 0);
  return w;
}

MeshTouches touch_wall(const WallModel& w, const Vec3& centre, double radius, const int* first, const int* last) {
  if (w.is_mesh()) return touch_mesh(w.triangles, first, last, centre, radius);
  MeshTouches out;
  if (const auto* plane = std::get_if<PlaneShape>(&w.wall.shape)) {
    out.touch[0] = touch_plane(*plane, centre);
    out.count = out.touch[0].distance < radius;
  } else if (const auto t = touch_cylinder(std::get<CylinderShape>(w.wall.shape), centre, radius)) {
    out.touch[0] = *t;
    out.count = 1;
  }
  return out;
}
}  // namespace venato::dem
