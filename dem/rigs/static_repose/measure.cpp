#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/rigs/static_repose/rig.h"
#include "dem/rigs/support/statistics.h"

namespace venato::dem::rigs::static_repose {
namespace {
constexpr double kDeg = 180 / std::numbers::pi, kMm = 1e3;
// A heap in which grains still travel one diameter per second is not at rest.
constexpr double kRestingDiametersPerSecond = 1;
constexpr double kPixel = 0.25;  // of a mean grain: of the map of heights
const double kNan = std::numeric_limits<double>::quiet_NaN();

struct Place {
  double radius, angle;
};
/// Mean x, y by volume.
Vec3 axis_of(const std::vector<GrainRecord>& grains) {
  Vec3 sum = Vec3::Zero();
  double volume = 0;
  for (const GrainRecord& g : grains) {
    const double v = std::pow(g.diameter_m, 3);
    sum += v * g.position_m, volume += v;
  }
  return sum / volume;
}
double angle_of(double x, double y) {
  const double angle = std::atan2(y, x);
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}
std::size_t wedge_of(double angle, int wedges) {
  return static_cast<std::size_t>(std::min(wedges - 1, static_cast<int>(angle / (2 * std::numbers::pi) * wedges)));
}
Place place_of(const GrainRecord& g, const Vec3& axis) {
  const double x = g.position_m.x() - axis.x(), y = g.position_m.y() - axis.y();
  return {std::hypot(x, y), angle_of(x, y)};
}

/// Heap seen from above: height of the highest sphere over each pixel, 0 where there is none; square, centred on the axis.
std::vector<double> height_map(const std::vector<GrainRecord>& grains, const Vec3& axis, double floor_z, double reach, double grain) {
  const double pixel = grain * kPixel;
  const auto half = static_cast<std::ptrdiff_t>(std::ceil(reach / pixel)), side = 2 * half;
  std::vector<double> map(static_cast<std::size_t>(side * side), 0);
  for (const GrainRecord& g : grains) {
    const double r = 0.5 * g.diameter_m, x = (g.position_m.x() - axis.x()) / pixel + static_cast<double>(half);
    const double y = (g.position_m.y() - axis.y()) / pixel + static_cast<double>(half), span = r / pixel;
    const auto first = [&](double at) { return std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(std::floor(at - span))); };
    const auto last = [&](double at) { return std::min(side - 1, static_cast<std::ptrdiff_t>(std::ceil(at + span))); };
    for (std::ptrdiff_t j = first(y); j <= last(y); ++j)
      for (std::ptrdiff_t i = first(x); i <= last(x); ++i) {
        const double dx = (static_cast<double>(i) + 0.5 - x) * pixel, dy = (static_cast<double>(j) + 0.5 - y) * pixel,
                     rest = r * r - dx * dx - dy * dy;
        if (rest <= 0) continue;
        double& height = map[static_cast<std::size_t>(j * side + i)];
        height = std::max(height, g.position_m.z() + std::sqrt(rest) - floor_z);
      }
  }
  return map;
}

/// Angle of the cone with the same first moments: mean height H / 4, mean distance from the axis R / 2. Per wedge: where its own grains lie.
double moment_angle_deg(const std::vector<GrainRecord>& grains, const Vec3& axis, double floor_z, int wedge, int wedges) {
  double volume = 0, height = 0, radius = 0;
  for (const GrainRecord& g : grains) {
    const Place p = place_of(g, axis);
    if (wedge >= 0 && wedge_of(p.angle, wedges) != static_cast<std::size_t>(wedge)) continue;
    const double v = std::pow(g.diameter_m, 3);
    volume += v, height += v * (g.position_m.z() - floor_z), radius += v * p.radius;
  }
  return volume > 0 && radius > 0 ? std::atan(2 * height / radius) * kDeg : kNan;
}
}  // namespace

Profile heap_profile(const std::vector<GrainRecord>& grains, const Config& c) {
  Profile p;
  if (grains.empty()) return p;
  double cubes = 0;
  for (const GrainRecord& g : grains) cubes += std::pow(g.diameter_m, 3);
  p.grain_m = std::cbrt(cubes / static_cast<double>(grains.size()));
  const double width = c.ring_width_m > 0 ? c.ring_width_m : p.grain_m;
  const Vec3 axis = axis_of(grains);
  double farthest = 0;
  for (const GrainRecord& g : grains) farthest = std::max(farthest, place_of(g, axis).radius);
  const auto rings = static_cast<std::size_t>(farthest / width) + 1, wedges = static_cast<std::size_t>(c.wedges);
  const std::vector<double> height = height_map(grains, axis, c.floor_z_m, static_cast<double>(rings) * width, p.grain_m);
  const double pixel = p.grain_m * kPixel;
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(height.size()))));
  std::vector<double> sum(rings * wedges, 0), count(rings * wedges, 0);
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i) {
      const double x = (static_cast<double>(i) + 0.5 - 0.5 * static_cast<double>(side)) * pixel;
      const double y = (static_cast<double>(j) + 0.5 - 0.5 * static_cast<double>(side)) * pixel;
      const auto ring = static_cast<std::size_t>(std::hypot(x, y) / width);
      if (ring >= rings) continue;
      const std::size_t wedge = wedge_of(angle_of(x, y), c.wedges);
      sum[ring * wedges + wedge] += height[j * side + i], count[ring * wedges + wedge] += 1;
    }
  p.height_m.assign(rings, 0);
  p.wedge_height_m.assign(wedges, std::vector<double>(rings, 0));
  for (std::size_t k = 0; k < rings; ++k) {
    p.radius_m.push_back((static_cast<double>(k) + 0.5) * width);
    double all = 0, pixels = 0;
    for (std::size_t w = 0; w < wedges; ++w) {
      all += sum[k * wedges + w], pixels += count[k * wedges + w];
      p.wedge_height_m[w][k] = count[k * wedges + w] > 0 ? sum[k * wedges + w] / count[k * wedges + w] : 0;
    }
    p.height_m[k] = pixels > 0 ? all / pixels : 0;
  }
  return p;
}

double flank_angle_deg(const std::vector<double>& radius, const std::vector<double>& height, const Config& c, double* rms_m, double* foot_m) {
  if (rms_m) *rms_m = kNan;
  if (foot_m) *foot_m = kNan;
  if (height.empty()) return kNan;
  const double apex = *std::max_element(height.begin(), height.end());
  if (!(apex > 0)) return kNan;
  std::size_t first = 0;
  for (std::size_t k = 0; k < height.size(); ++k)
    if (height[k] > c.fit_to * apex) first = k + 1;
  std::vector<double> x, y;
  for (std::size_t k = first; k < height.size() && height[k] >= c.fit_from * apex; ++k) x.push_back(radius[k]), y.push_back(height[k]);
  if (x.size() < 3) return kNan;
  const LineFit fit = fit_line(x, y);
  if (rms_m) *rms_m = fit.rms;
  if (foot_m) *foot_m = -fit.intercept / fit.slope;
  return std::atan(-fit.slope) * kDeg;
}

RigResult measure(const Config& config, const Case& c, const CaseResult& r) {
  RigResult out;
  const Profile p = heap_profile(r.final_state, config);
  const std::string from = std::to_string(config.wedges) + " wedges";
  double rms = kNan, foot = kNan;
  const double angle = flank_angle_deg(p.radius_m, p.height_m, config, &rms, &foot);
  std::vector<double> of_wedge, moment_of_wedge, apex_of_wedge;
  const Vec3 axis = r.final_state.empty() ? Vec3(Vec3::Zero()) : axis_of(r.final_state);
  for (int w = 0; w < config.wedges && !p.height_m.empty(); ++w) {
    const auto& height = p.wedge_height_m[static_cast<std::size_t>(w)];
    of_wedge.push_back(flank_angle_deg(p.radius_m, height, config));
    moment_of_wedge.push_back(moment_angle_deg(r.final_state, axis, config.floor_z_m, w, config.wedges));
    apex_of_wedge.push_back(*std::max_element(height.begin(), height.end()) * kMm);
  }
  const double apex = p.height_m.empty() ? kNan : *std::max_element(p.height_m.begin(), p.height_m.end());
  out.kpis = {{"repose_angle_deg", angle, mean_of(of_wedge).standard_error, "deg",
               "static angle of repose: straight line through the flank of the heap's profile", from},
              {"repose_angle_by_moments_deg", p.height_m.empty() ? kNan : moment_angle_deg(r.final_state, axis, config.floor_z_m, -1, 1),
               mean_of(moment_of_wedge).standard_error, "deg",
               "slope of the cone with the same mean height and mean radius: a second way to the angle", from},
              {"heap_apex_mm", apex * kMm, mean_of(apex_of_wedge).standard_error, "mm", "highest ring of the profile", from},
              {"heap_foot_radius_mm", foot * kMm, kNan, "mm", "where the fitted flank meets the plate", ""},
              {"flank_rms_mm", rms * kMm, kNan, "mm", "deviation of the flank from its straight line", ""}};

  if (std::isnan(angle)) out.warnings.push_back("static_repose: the heap has fewer than three rings of flank; no angle (more or smaller grains)");
  if (rms > p.grain_m)
    out.warnings.push_back("static_repose: the flank deviates from a straight line by " + short_number(rms * kMm) +
                           " mm rms, more than a mean grain (" + short_number(p.grain_m * kMm) + " mm): this is no cone");
  if (apex < 10 * p.grain_m)  // verification: heap over grain >= 10 for 1-2 degrees
    out.warnings.push_back("static_repose: the heap is only " + short_number(std::round(10 * apex / p.grain_m) / 10) +
                           " mean grains high; below about 10 its rounded top and foot lower the angle");
  double moving = 0, mass = 0;
  for (const GrainRecord& g : r.final_state) {
    const double m = std::pow(g.diameter_m, 3);
    mass += m, moving += m * g.velocity_m_s.norm();
  }
  if (mass > 0 && moving / mass > kRestingDiametersPerSecond * p.grain_m)
    out.warnings.push_back("static_repose: the heap still moves at " + short_number(moving / mass * kMm) + " mm/s on average; let it rest longer");

  RigTable table{"heap_profile",
                 {{"radius_mm", "mm", "middle of the ring", {}},
                  {"height_mm", "mm", "height of the surface, mean over the ring", {}},
                  {"standard_error_mm", "mm", "of the height, from the wedges", {}}}};
  Series points{"heap", {}, {}, {}, {}, SeriesStyle::points, ""}, line{"flank", {}, {}, {}, {}, SeriesStyle::line, ""};
  for (std::size_t k = 0; k < p.radius_m.size(); ++k) {
    std::vector<double> wedge;
    for (const auto& w : p.wedge_height_m) wedge.push_back(w[k]);
    const double error = mean_of(wedge).standard_error;
    const double row[] = {p.radius_m[k] * kMm, p.height_m[k] * kMm, error * kMm};
    for (std::size_t i = 0; i < 3; ++i) table.columns[i].values.push_back(row[i]);
    points.x.push_back(row[0]), points.y.push_back(row[1]), points.y_low.push_back(row[1] - row[2]), points.y_high.push_back(row[1] + row[2]);
  }
  Plot plot;
  plot.title = c.name + ": heap profile";
  if (!std::isnan(angle)) {
    char text[80];
    std::snprintf(text, sizeof text, ", angle of repose %.1f +- %.1f deg", angle, out.kpis[0].standard_error);
    plot.title += text;
    const double slope = std::tan(angle / kDeg);
    for (const double share : {config.fit_to, config.fit_from}) {
      const double h = share * apex;
      line.x.push_back((foot - h / slope) * kMm), line.y.push_back(h * kMm);
    }
  }
  plot.x_label = "distance from the axis [mm]";
  plot.y_label = "height [mm]";
  plot.series = {points, line};
  out.plots.push_back({"heap_profile", plot});
  out.tables.push_back(table);
  return out;
}
}  // namespace venato::dem::rigs::static_repose
