#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/units.h"
#include "dem/case_reader_parts.h"
#include "dem/material_reader.h"

namespace venato::dem {
namespace {
constexpr Range kPlace{-1e5, 1e5, "mm"};
constexpr double kForever_s = 1e9;
constexpr double kLiftShare = 0.4;  // of a tap's period
constexpr int kFallKnots = 12;      // of the parabola of a free fall: speeds right to 4 %
const std::vector<double> kZero{0, 0, 0};

/// A direction as typed; an issue when it has no length.
void read_direction(ObjectReader& r, std::string_view key, Vec3& out, std::string_view help) {
  Vec3 v = out;
  read_vec3(r, key, v, {-1e6, 1e6, ""}, {.help = help});
  if (v.norm() > 0)
    out = v.normalized();
  else
    r.issue(key, "the direction has no length", "e.g. [0, 0, 1]");
}

void read_plane(ObjectReader& r, PlaneShape& plane) {
  read_vec3(r, "point_mm", plane.point, kPlace, {.help = "a point of the plane"});
  read_direction(r, "normal", plane.normal, "towards the side where the grains are; any length");
}

void read_cylinder(ObjectReader& r, CylinderShape& cylinder) {
  read_vec3(r, "base_mm", cylinder.base, kPlace, {.help = "centre of one end"});
  read_direction(r, "axis", cylinder.axis, "from there to the other end; any length");
  r.number("length_mm", cylinder.length_m, {1e-3, 1e5, "mm"}, {.help = "length; the ends are open"});
  r.number("radius_mm", cylinder.radius_m, {1e-3, 1e5, "mm"}, {.help = "radius"});
  r.choice("grains", cylinder.inside, {{"inside", true}, {"outside", false}}, {.help = "where the grains are"});
}

void read_profile(ObjectReader& r, const Case& c, WallShape& shape) {
  std::vector<double> flat;
  r.tuples("points_mm", flat, 2, kPlace, 2, 10000, {.help = "polyline of (y, z) points, extruded across the box"});
  std::vector<std::pair<double, double>> points;
  for (std::size_t k = 0; k + 1 < flat.size(); k += 2) points.emplace_back(flat[k], flat[k + 1]);
  if (points.size() < 2 || !(c.box.high.x() > c.box.low.x())) return;
  try {
    shape = extrude_profile(points, c.box.low.x(), c.box.high.x());
  } catch (const UsageError& e) {
    r.issue("points_mm", e.what());
  }
}

void read_ring(ObjectReader& r, WallShape& shape) {
  Vec3 centre = Vec3::Zero(), normal = Vec3::UnitZ();
  double inner = 0, outer = 0;
  read_vec3(r, "centre_mm", centre, kPlace, {.help = "centre"});
  read_direction(r, "normal", normal, "across the ring's plane; any length, either side (grains touch both)");
  r.number("inner_radius_mm", inner, {0, 1e5, "mm"}, {.help = "radius of the hole; 0 = a full disc", .fallback = 0.0});
  r.number("outer_radius_mm", outer, {1e-3, 1e5, "mm"}, {.help = "outer radius"});
  if (r.describing()) return;
  if (!(outer > inner)) {
    r.issue("outer_radius_mm", "the outer radius is not larger than the inner one", "inner_radius_mm < outer_radius_mm");
    return;
  }
  shape = make_ring(centre, normal, inner, outer);
}

void read_mesh(ObjectReader& r, WallShape& shape) {
  std::filesystem::path file;
  double scale = 1e-3;
  Vec3 offset = Vec3::Zero();
  r.path("file", file, PathKind::existing_file, {.help = "STL, OBJ, PLY … file"});
  r.number("file_unit_mm", scale, {1e-3, 1e4, "mm"}, {.help = "length of one unit of the file: 1 = drawn in mm, 1000 = in m", .fallback = 1.0});
  read_vec3(r, "offset_mm", offset, kPlace, {.help = "shift of the mesh after scaling", .fallback = kZero});
  if (file.empty() || r.describing()) return;
  try {
    MeshShape mesh = load_mesh(file, scale);
    for (Triangle& t : mesh.triangles) t.a += offset, t.b += offset, t.c += offset;
    shape = std::move(mesh);
  } catch (const UsageError& e) {
    r.issue("file", e.what());
  }
}

void read_vibration(ObjectReader& r, WallMotion& m) {
  read_vec3(r, "amplitude_um", m.vibration_amplitude_m, {-20000, 20000, "um"}, {.help = "amplitude (half of peak to peak) along x, y, z"});
  r.number("frequency_hz", m.vibration_hz, {0.1, 1e5, "Hz"}, {.help = "frequency"});
  r.number("phase_deg", m.vibration_phase_rad, {-360, 360, "deg"}, {.help = "phase at switching on", .fallback = 0.0});
  read_intervals(r, "when_s", m.vibrate_when, "on/off schedule, [on, off] each; empty = always");
}

void read_track(ObjectReader& r, WallMotion& m) {
  if (!r.has("track") && !r.describing()) return;
  r.objects("track", "actuator track: offset linear between the knots, held before and after", 2, 10000, [&m](ObjectReader& o, std::size_t k) {
    WallMotion::PositionKnot knot{0, Vec3::Zero()};
    o.number("time_s", knot.time_s, {0, kForever_s, "s"}, {.help = "time of the knot"});
    read_vec3(o, "offset_mm", knot.offset_m, kPlace, {.help = "offset from the drawn place"});
    if (k > 0 && !m.track.empty() && !(knot.time_s > m.track.back().time_s))
      o.issue("time_s", "the knots are not in rising order of time", "sort them");
    m.track.push_back(knot);
  });
}
/// Taps of a tapped-density tester as an actuator track: lifted evenly in the first part of a period, free fall, rest.
void read_tapping(ObjectReader& o, WallMotion& m) {
  double from = 0, height = 0, period = 0;
  int count = 0;
  o.number("from_s", from, {0, kForever_s, "s"}, {.help = "first lift"});
  o.number("height_mm", height, {1e-3, 100, "mm"}, {.help = "drop height of a tap (upwards, z)"});
  o.number("period_s", period, {1e-3, 1e4, "s"}, {.help = "time from tap to tap"});
  o.integer("count", count, {1, 2000, ""}, {.help = "number of taps"});
  if (o.describing() || !(height > 0) || !(period > 0)) return;
  const double fall = std::sqrt(2 * height / kStandardGravity_m_s2), lift = kLiftShare * period;
  if (lift + fall > 0.9 * period) {
    o.issue("period_s", "too short: lifting takes " + std::to_string(lift) + " s and falling " + std::to_string(fall) + " s", "leave time to rest");
    return;
  }
  for (int tap = 0; tap < count; ++tap) {
    const double start = from + tap * period;
    m.track.push_back({start, Vec3::Zero()});
    for (int k = 0; k <= kFallKnots; ++k) {
      const double share = static_cast<double>(k) / kFallKnots;
      m.track.push_back({start + lift + share * fall, Vec3(0, 0, height * (1 - share * share))});
    }
  }
}
}  // namespace

void read_motion(ObjectReader& r, WallMotion& m) {
  read_vec3(r, "velocity_m_s", m.velocity_m_s, {-100, 100, "m/s"}, {.help = "constant translation", .fallback = kZero});
  read_intervals(r, "translate_when_s", m.translate_when, "when it translates, [on, off] each; empty = always");
  read_track(r, m);
  r.optional_object("rotation", "rotation about a fixed point", [&m](ObjectReader& o) {
    read_vec3(o, "centre_mm", m.rotation_centre, kPlace, {.help = "point on the axis"});
    read_vec3(o, "speed_deg_s", m.rotation_rad_s, {-1e5, 1e5, "deg/s"}, {.help = "rotation vector (right-hand rule)"});
  });
  if (r.optional_object("tapping", "taps of a tapped-density tester: lifted and dropped, again and again",
                        [&m](ObjectReader& o) { read_tapping(o, m); }) &&
      r.has("track"))
    r.issue("tapping", "there is a track too", "tapping is a track: give one of them");
  r.optional_object("vibration", "sinusoidal vibration", [&m](ObjectReader& o) { read_vibration(o, m); });
  read_vec3(r, "surface_velocity_m_s", m.surface_velocity_m_s, {-100, 100, "m/s"},
            {.help = "belt: the wall stays, its surface moves", .fallback = kZero});
}

void read_wall(ObjectReader& r, const Case& c, Wall& wall) {
  r.name("name", wall.name, {.help = "name of the wall"});
  const int material = read_material_name(r, "material", c.materials, "what it is made of");
  if (material >= 0) wall.material = material;
  r.pick("shape", "shape of the wall",
         {{"plane", "infinite plane", [&](ObjectReader& b) { read_plane(b, wall.shape.emplace<PlaneShape>()); }},
          {"cylinder", "cylinder with open ends", [&](ObjectReader& b) { read_cylinder(b, wall.shape.emplace<CylinderShape>()); }},
          {"profile", "polyline in (y, z), extruded across the box", [&](ObjectReader& b) { read_profile(b, c, wall.shape); }},
          {"ring", "flat ring or disc: a plate with a round hole, a lid, the end of a drum", [&](ObjectReader& b) { read_ring(b, wall.shape); }},
          {"mesh", "triangles from a file", [&](ObjectReader& b) { read_mesh(b, wall.shape); }}});
  r.optional_object("motion", "rigid motion; the parts add up", [&](ObjectReader& o) { read_motion(o, wall.motion); });
  r.optional_object("present", "the wall exists only then (gates, lids)", [&](ObjectReader& o) {
    o.number("from_s", wall.present.on_s, {0, kForever_s, "s"}, {.help = "appears", .fallback = 0.0});
    o.number("to_s", wall.present.off_s, {0, kForever_s, "s"}, {.help = "disappears", .fallback = kForever_s});
    if (!(wall.present.off_s > wall.present.on_s)) o.issue("to_s", "the wall disappears before it appears", "from_s < to_s");
  });
}
}  // namespace venato::dem
