#include "dem/walls/motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace venato::dem {
namespace {
/// Time spent inside the intervals before t; no intervals = always.
double active_time(const std::vector<Interval>& when, double t) {
  if (when.empty()) return std::max(t, 0.0);
  double sum = 0;
  for (const Interval& i : when) sum += std::max(0.0, std::min(t, i.off_s) - std::max(i.on_s, 0.0));
  return sum;
}

Vec3 track_offset(const std::vector<WallMotion::PositionKnot>& track, double t) {
  if (track.empty()) return Vec3::Zero();
  if (t <= track.front().time_s) return track.front().offset_m;
  for (std::size_t k = 1; k < track.size(); ++k)
    if (t < track[k].time_s) {
      const auto &a = track[k - 1], &b = track[k];
      return a.offset_m + (t - a.time_s) / (b.time_s - a.time_s) * (b.offset_m - a.offset_m);
    }
  return track.back().offset_m;
}
}  // namespace

Vec3 vibration_offset(const WallMotion& m, double t) {
  if (m.vibration_hz <= 0 || m.vibration_amplitude_m.isZero(0)) return Vec3::Zero();
  double start = 0;
  if (!m.vibrate_when.empty()) {
    const Interval* last = nullptr;
    for (const Interval& i : m.vibrate_when)
      if (i.on_s <= t && (!last || i.on_s > last->on_s)) last = &i;
    if (!last) return Vec3::Zero();
    start = last->on_s;
    // sin(w t' + phase) = sin(phase) again after half a period when phase is a multiple of pi, else after a whole one.
    const bool half = std::abs(std::sin(m.vibration_phase_rad)) < 1e-12;
    const double swing = (half ? 0.5 : 1.0) / m.vibration_hz;
    if (std::isfinite(last->off_s) && t >= start + std::ceil((last->off_s - start) / swing - 1e-9) * swing) return Vec3::Zero();
  } else if (t < 0) {
    return Vec3::Zero();
  }
  const double angle = 2 * std::numbers::pi * m.vibration_hz * (t - start) + m.vibration_phase_rad;
  return (std::sin(angle) - std::sin(m.vibration_phase_rad)) * m.vibration_amplitude_m;
}

WallPose wall_pose(const WallMotion& m, double t) {
  WallPose p;
  p.steady_offset_m = active_time(m.translate_when, t) * m.velocity_m_s + track_offset(m.track, t);
  p.offset_m = p.steady_offset_m + vibration_offset(m, t);
  const double rate = m.rotation_rad_s.norm();
  if (rate > 0) {
    p.turn = Eigen::AngleAxisd(rate * t, m.rotation_rad_s / rate).toRotationMatrix();
    p.turned = true;
  }
  return p;
}

double pose_distance(const WallMotion& m, const WallPose& a, const WallPose& b, double reach) {
  double d = (a.steady_offset_m - b.steady_offset_m).norm();
  if (m.rotation_rad_s.norm() > 0) d += reach * Eigen::AngleAxisd(Eigen::Matrix3d(a.turn.transpose() * b.turn)).angle();
  return d;
}

void check_motion(const std::string& wall, const WallMotion& m) {
  auto fail = [&](const std::string& why) { throw UsageError("wall '" + wall + "': " + why); };
  if (!m.velocity_m_s.allFinite() || !m.rotation_rad_s.allFinite() || !m.rotation_centre.allFinite() || !m.vibration_amplitude_m.allFinite() ||
      !m.surface_velocity_m_s.allFinite() || !std::isfinite(m.vibration_hz) || !std::isfinite(m.vibration_phase_rad))
    fail("its motion contains a number that is not finite");
  if (m.vibration_amplitude_m.norm() > 0 && !(m.vibration_hz > 0)) fail("vibration amplitude without a frequency > 0 Hz");
  for (std::size_t k = 1; k < m.track.size(); ++k)
    if (!(m.track[k].time_s > m.track[k - 1].time_s)) fail("track times must rise; knot " + std::to_string(k) + " does not");
  for (const auto* list : {&m.translate_when, &m.vibrate_when})
    for (const Interval& i : *list)
      if (!(i.off_s >= i.on_s)) fail("an interval ends (" + std::to_string(i.off_s) + " s) before it starts (" + std::to_string(i.on_s) + " s)");
}
}  // namespace venato::dem
