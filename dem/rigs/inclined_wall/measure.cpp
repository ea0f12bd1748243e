#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "dem/coarse_graining/openings.h"
#include "dem/rigs/inclined_wall/rig.h"
#include "dem/rigs/support/statistics.h"
#include "dem/walls/motion.h"

namespace venato::dem::rigs::inclined_wall {
namespace {
const double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDeg = 180 / std::numbers::pi;
const std::string kFrom = "6 strips";

const PlaneShape& plate(const Case& c, const Config& config) { return std::get<PlaneShape>(c.walls.at(config.wall).shape); }

/// Where a grain is on the plate as drawn: turned back, without the distance from the plate.
Vec3 on_plate(const Vec3& position, const WallPose& pose, const WallMotion& motion, const PlaneShape& plane) {
  const Vec3 drawn = motion.rotation_centre + pose.turn.transpose() * (position - motion.rotation_centre - pose.offset_m);
  return drawn - drawn.dot(plane.normal) * plane.normal;
}
}  // namespace

double tilt_deg(const Case& c, const Config& config, double t) {
  const Vec3 normal = wall_pose(c.walls.at(config.wall).motion, t).turn * plate(c, config).normal;
  return std::acos(std::clamp(-normal.dot(c.gravity_m_s2.normalized()), -1.0, 1.0)) * kDeg;
}

std::vector<std::vector<double>> share_off(const std::vector<Snapshot>& frames, const Case& c, const Config& config) {
  std::vector<std::vector<double>> share(kStrips + 1, std::vector<double>(frames.size(), 0));
  if (frames.empty() || frames.front().id.empty()) return share;
  const Snapshot& first = frames.front();
  const WallMotion& motion = c.walls.at(config.wall).motion;
  const PlaneShape& plane = plate(c, config);
  const double far = config.moved_m > 0 ? config.moved_m : mean_volume_grain_m(c);
  const std::size_t n = first.id.size();
  const WallPose start = wall_pose(motion, first.time_s);
  std::vector<Vec3> home;
  for (const Vec3& p : first.position_m) home.push_back(on_plate(p, start, motion, plane));
  // Strips of equal number along the axis of rotation.
  const Vec3 axis = motion.rotation_rad_s.normalized();
  std::vector<std::size_t> order(n), strip(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double x = home[a].dot(axis), y = home[b].dot(axis);
    return x != y ? x < y : a < b;
  });
  for (std::size_t k = 0; k < n; ++k) strip[order[k]] = k * kStrips / n;
  std::vector<double> total(kStrips + 1, 0);
  const auto mass = [&](std::size_t k) { return std::pow(static_cast<double>(first.radius_m[k]), 3); };
  for (std::size_t k = 0; k < n; ++k) total[strip[k]] += mass(k), total[kStrips] += mass(k);
  std::vector<std::uint8_t> off(n, 0);  // once off, off
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const WallPose pose = wall_pose(motion, frames[f].time_s);
    std::size_t at = 0;
    for (std::size_t k = 0; k < n; ++k) {  // ids rise in both lists
      while (at < frames[f].id.size() && frames[f].id[at] < first.id[k]) ++at;
      const bool here = at < frames[f].id.size() && frames[f].id[at] == first.id[k];
      if (!here || (on_plate(frames[f].position_m[at], pose, motion, plane) - home[k]).norm() > far) off[k] = 1;
      if (off[k]) share[strip[k]][f] += mass(k), share[kStrips][f] += mass(k);
    }
    for (std::size_t s = 0; s <= kStrips; ++s) share[s][f] = total[s] > 0 ? share[s][f] / total[s] : kNan;
  }
  return share;
}

double angle_at(const std::vector<double>& angle, const std::vector<double>& share, double wanted) {
  for (std::size_t k = 0; k < share.size(); ++k) {
    if (!(share[k] >= wanted)) continue;
    if (k == 0) return angle[0];
    return angle[k - 1] + (angle[k] - angle[k - 1]) * (wanted - share[k - 1]) / (share[k] - share[k - 1]);
  }
  return kNan;
}

RigResult measure(const Config& config, const Case& c, const CaseResult& r) {
  RigResult out;
  const auto& frames = r.snapshots.at(config.plan);
  const auto share = share_off(frames, c, config);
  std::vector<double> angle;
  for (const Snapshot& s : frames) angle.push_back(tilt_deg(c, config, s.time_s));
  const auto add = [&](const char* name, double wanted, const char* what) {
    std::vector<double> of_strip;
    for (int s = 0; s < kStrips; ++s) of_strip.push_back(angle_at(angle, share[static_cast<std::size_t>(s)], wanted));
    out.kpis.push_back({name, angle_at(angle, share[kStrips], wanted), mean_of(of_strip).standard_error, "deg", what, kFrom});
  };
  add("slide_angle_deg", 0.5, "tilt at which half of the powder (by mass) has moved off its place");
  add("first_slide_angle_deg", 0.1, "tilt at which 10 % has moved");
  add("last_slide_angle_deg", 0.9, "tilt at which 90 % has moved");
  if (std::isnan(out.kpis[0].value))
    out.warnings.push_back("inclined_wall: less than half of the powder moved up to " + short_number(angle.empty() ? kNan : angle.back()) +
                           " deg; tilt farther");
  else if (!angle.empty() && out.kpis[0].value <= angle.front())
    out.warnings.push_back("inclined_wall: half of the powder had moved in the first frame; begin at a smaller tilt");
  RigTable table{"inclined_wall",
                 {{"tilt_deg", "deg", "tilt of the plate", {}}, {"share_off", "1", "share of the powder that has moved off its place", {}}}};
  table.columns[0].values = angle, table.columns[1].values = share[kStrips];
  Plot plot;
  plot.title = c.name + ": powder off its place";
  plot.x_label = "tilt of the plate [deg]", plot.y_label = "share of the mass [1]";
  for (std::size_t s = 0; s <= kStrips; ++s)
    plot.series.push_back({s == kStrips ? "all"
                           : s == 0     ? "strips"
                                        : "",
                           angle,
                           share[s],
                           {},
                           {},
                           SeriesStyle::line,
                           s == kStrips ? "#0072b2" : "#bbbbbb"});
  plot.y_range = std::pair(0.0, 1.0);
  out.plots.push_back({"inclined_wall", plot});
  out.tables.push_back(table);
  return out;
}
}  // namespace venato::dem::rigs::inclined_wall
