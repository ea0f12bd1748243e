#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/coarse_graining/openings.h"
#include "dem/rigs/dynamic_repose/rig.h"
#include "dem/rigs/support/statistics.h"

namespace venato::dem::rigs::dynamic_repose {
namespace {
const double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMm = 1e3, kDeg = 180 / std::numbers::pi, kRpm = 30 / std::numbers::pi;
constexpr std::size_t kBlocks = 8;
constexpr double kDriftThatMatters_deg = 1;
constexpr double kFewestGrainsAcross = 12;  // drum radius over a mean grain
const std::string kFrom = "8 time blocks";

struct Measured {
  double angle, angle_error;
  double drift_deg, drift_error_deg;  ///< over the window: straight line through the blocks
  double fluctuation_mm, fluctuation_error_mm;
  Surface surface;
};

Measured measure_plateau(const std::vector<Snapshot>& frames, const Config& config, double grain) {
  Measured m{kNan, kNan, kNan, kNan, kNan, kNan, {}};
  std::vector<const Snapshot*> all;
  for (const Snapshot& s : frames) all.push_back(&s);
  if (all.size() < 2 * kBlocks) return m;
  m.surface = free_surface(all, config, grain);
  std::vector<double> angles, fluctuations;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::size_t from = b * all.size() / kBlocks, to = (b + 1) * all.size() / kBlocks;
    const std::vector<const Snapshot*> block(all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(to));
    angles.push_back(std::abs(surface_angle_deg(free_surface(block, config, grain), config)));
    // How far the surface of single frames is from the mean surface, rms over the central columns.
    double squares = 0, count = 0;
    for (const Snapshot* s : block) {
      const Surface one = free_surface({s}, config, grain);
      for (std::size_t k = 0; k < one.height_m.size() && k < m.surface.height_m.size(); ++k) {
        const double d = one.height_m[k] - m.surface.height_m[k];
        if (std::abs(one.across_m[k]) > config.central * config.radius_m || std::isnan(d)) continue;
        squares += d * d, count += 1;
      }
    }
    fluctuations.push_back(count > 0 ? std::sqrt(squares / count) * kMm : kNan);
  }
  m.angle = std::abs(surface_angle_deg(m.surface, config));
  m.angle_error = mean_of(angles).standard_error;
  std::vector<double> number;
  for (std::size_t b = 0; b < kBlocks; ++b) number.push_back(static_cast<double>(b));
  const LineFit line = fit_line(number, angles);
  m.drift_deg = line.slope * kBlocks, m.drift_error_deg = line.slope_error * kBlocks;
  m.fluctuation_mm = mean_of(fluctuations).mean, m.fluctuation_error_mm = mean_of(fluctuations).standard_error;
  return m;
}
}  // namespace

RigResult measure(const Config& config, const Case& c, const CaseResult& r) {
  RigResult out;
  const double grain = mean_volume_grain_m(c), gravity = c.gravity_m_s2.norm();
  if (config.radius_m < kFewestGrainsAcross * grain)
    out.warnings.push_back("dynamic_repose: the drum's radius is only " + short_number(std::round(10 * config.radius_m / grain) / 10) +
                           " mean grains; below 12 the surface has hardly a straight part");
  RigTable table{"dynamic_repose",
                 {{"speed_deg_s", "deg/s", "speed of the drum", {}},
                  {"froude", "1", "speed^2 radius / gravity", {}},
                  {"angle_deg", "deg", "slope of the middle of the free surface", {}},
                  {"standard_error_deg", "deg", "of the angle, from 8 time blocks", {}},
                  {"fluctuation_mm", "mm", "rms distance of single frames' surfaces from the mean one", {}}}};
  Series points{"slope of the middle", {}, {}, {}, {}, SeriesStyle::points, ""};
  Plot surfaces;
  surfaces.title = c.name + ": free surface";
  surfaces.x_label = "across [mm]", surfaces.y_label = "height [mm]";
  Series drum{"drum", {}, {}, {}, {}, SeriesStyle::line, "#999999"};
  for (int k = 0; k <= 72; ++k) {
    drum.x.push_back(config.radius_m * kMm * std::cos(k * 5 / kDeg));
    drum.y.push_back(config.radius_m * kMm * std::sin(k * 5 / kDeg));
  }
  surfaces.series.push_back(drum);
  for (const Plateau& p : config.plateaus) {
    const Measured m = measure_plateau(r.snapshots.at(p.plan), config, grain);
    const std::string speed = short_number(std::round(1e4 * p.speed_rad_s * kRpm) / 1e4);
    out.kpis.push_back({"dynamic_angle_at_" + speed + "_rpm_deg", m.angle, m.angle_error, "deg",
                        "slope of the middle of the free surface against the horizontal, drum at " + speed + " rpm", kFrom});
    out.kpis.push_back({"surface_fluctuation_at_" + speed + "_rpm_mm", m.fluctuation_mm, m.fluctuation_error_mm, "mm",
                        "rms distance of the surface of single frames from the mean surface", kFrom});
    if (std::isnan(m.angle)) out.warnings.push_back("dynamic_repose: no free surface could be found at " + speed + " rpm");
    // Scatter about the line, not about the mean, tells a drift from noise; a drift below a degree does not matter.
    if (std::abs(m.drift_deg) > std::max(kDriftThatMatters_deg, 3 * m.drift_error_deg))
      out.warnings.push_back("dynamic_repose: the angle at " + speed + " rpm drifts by " + short_number(std::round(10 * m.drift_deg) / 10) +
                             " deg over its window: not steady yet, start later");
    const double row[] = {p.speed_rad_s * kDeg, p.speed_rad_s * p.speed_rad_s * config.radius_m / gravity, m.angle, m.angle_error, m.fluctuation_mm};
    for (std::size_t k = 0; k < 5; ++k) table.columns[k].values.push_back(row[k]);
    points.x.push_back(p.speed_rad_s * kRpm), points.y.push_back(m.angle);
    points.y_low.push_back(m.angle - m.angle_error), points.y_high.push_back(m.angle + m.angle_error);
    Series line{speed + " rpm", {}, {}, {}, {}, SeriesStyle::line, ""};
    for (std::size_t k = 0; k < m.surface.across_m.size(); ++k)
      line.x.push_back(m.surface.across_m[k] * kMm), line.y.push_back(m.surface.height_m[k] * kMm);
    surfaces.series.push_back(line);
  }
  Plot angle;
  angle.title = c.name + ": dynamic angle of repose";
  angle.x_label = "speed of the drum [rpm]", angle.y_label = "angle [deg]";
  angle.series = {points};
  out.plots = {{"dynamic_repose", angle}, {"drum_surface", surfaces}};
  out.tables.push_back(table);
  return out;
}
}  // namespace venato::dem::rigs::dynamic_repose
