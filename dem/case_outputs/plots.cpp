#include "dem/case_outputs/plots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/plot/svg_plot.h"
#include "dem/case_outputs/labels.h"
#include "dem/fields/window_fields.h"

namespace venato::dem {
namespace {
constexpr double kMm = 1e3, kG = 1e3, kUj = 1e6;
constexpr int kMostCells = 4'000'000;
constexpr double kFlowBins = 60;  // enough to see a pulse, few enough that a bin holds several grains

std::vector<double> scaled(const std::vector<double>& v, double factor) {
  std::vector<double> out;
  for (double x : v) out.push_back(x * factor);
  return out;
}
Series line(std::string label, std::vector<double> x, std::vector<double> y) {
  Series s;
  s.label = std::move(label);
  s.x = std::move(x);
  s.y = std::move(y);
  return s;
}
Plot titled(const Case& c, const std::string& what, const char* x, const char* y) {
  Plot plot;
  plot.title = c.name + ": " + what;
  plot.x_label = x;
  plot.y_label = y;
  return plot;
}
}  // namespace

std::string counter_mass_svg(const Case& c, const CaseResult& r) {
  Plot plot = titled(c, "mass over the counters", "time [s]", "mass [g]");
  for (std::size_t k = 0; k < r.series.counter_mass_kg.size(); ++k)
    plot.series.push_back(line(counter_label(c, k), r.series.time_s, scaled(r.series.counter_mass_kg[k], kG)));
  return svg_plot(plot);
}

std::string flow_rate_svg(const Case& c, const CaseResult& r) {
  Plot plot = titled(c, "mass flow over the counters", "time [s]", "flow [g/s]");
  const double width = c.duration_s / kFlowBins;
  for (std::size_t k = 0; k < r.records.size(); ++k) {
    std::vector<double> time, flow(static_cast<std::size_t>(kFlowBins), 0);
    for (std::size_t b = 0; b < flow.size(); ++b) time.push_back((static_cast<double>(b) + 0.5) * width);
    for (const CounterRecord& record : r.records[k]) {
      const auto b = static_cast<std::size_t>(std::clamp(record.time_s / width, 0.0, kFlowBins - 1));
      flow[b] += record.mass_kg / width * kG;
    }
    plot.series.push_back(line(counter_label(c, k), time, flow));
  }
  return svg_plot(plot);
}

std::string kinetic_energy_svg(const Case& c, const CaseResult& r) {
  Plot plot = titled(c, "kinetic energy", "time [s]", "energy [uJ]");
  plot.series.push_back(line("all grains", r.series.time_s, scaled(r.series.kinetic_energy_j, kUj)));
  return svg_plot(plot);
}

std::optional<HeightProfile> height_profile(const Case& c, const std::vector<Snapshot>& frames) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (frames.size() < 3) return std::nullopt;
  double largest = 0;
  for (const Snapshot& frame : frames)
    for (float radius : frame.radius_m) largest = std::max(largest, 2 * static_cast<double>(radius));
  const Vec3 size = c.box.high - c.box.low;
  if (!(largest > 0) || !(size.minCoeff() > 0)) return std::nullopt;
  // Periodic y needs a whole number of cells in the box: the cell is fitted to the length (never below one grain).
  const int ny = std::max(1, static_cast<int>(size.y() / largest));
  FieldGrid grid{c.box.low.y(), c.box.low.z(), size.y() / ny, ny, 0};
  grid.nz = std::max(1, static_cast<int>(std::ceil(size.z() / grid.cell_m)));
  if (static_cast<double>(grid.ny) * grid.nz > kMostCells) return std::nullopt;
  FieldOptions options;
  options.slice_width_m = size.x();
  options.coarse_graining = c.coarse_graining;
  options.periodic_y = c.box.periodic[1];
  options.min_samples = 1;
  options.lag_s = frames[1].time_s - frames[0].time_s;  // the diffusivity is not shown
  const WindowFields fields = estimate_fields(frames, grid, options);
  // Not the fields' own solid fraction: that is 0 in cells that no displacement fell into.
  std::vector<double> volume(static_cast<std::size_t>(grid.nz), 0);
  for (const Snapshot& frame : frames)
    for (std::size_t k = 0; k < frame.id.size(); ++k) {
      const double row = std::floor((frame.position_m[k].z() - grid.z0_m) / grid.cell_m), radius = static_cast<double>(frame.radius_m[k]);
      if (row >= 0 && row < grid.nz) volume[static_cast<std::size_t>(row)] += 4.0 / 3 * std::numbers::pi * radius * radius * radius;
    }
  const double row_volume = size.x() * size.y() * grid.cell_m * static_cast<double>(frames.size());
  HeightProfile profile;
  for (int j = 0; j < grid.nz; ++j) {
    double solid = 0, flow_y = 0, flow_z = 0;
    for (int i = 0; i < grid.ny; ++i) {
      const std::size_t k = grid.index(i, j);
      solid += fields.solid_fraction[k];
      flow_y += fields.solid_fraction[k] * fields.velocity_y_m_s[k];
      flow_z += fields.solid_fraction[k] * fields.velocity_z_m_s[k];
    }
    profile.z_mm.push_back((grid.z0_m + (j + 0.5) * grid.cell_m) * kMm);
    profile.solid_fraction.push_back(volume[static_cast<std::size_t>(j)] / row_volume);
    profile.velocity_y_mm_s.push_back(solid > 0 ? flow_y / solid * kMm : nan);
    profile.velocity_z_mm_s.push_back(solid > 0 ? flow_z / solid * kMm : nan);
  }
  return profile;
}

std::string velocity_profile_svg(const Case& c, const HeightProfile& p) {
  Plot plot = titled(c, "mean velocity against height", "velocity [mm/s]", "height z [mm]");
  plot.series.push_back(line("along (y)", p.velocity_y_mm_s, p.z_mm));
  plot.series.push_back(line("up (z)", p.velocity_z_mm_s, p.z_mm));
  return svg_plot(plot);
}

std::string solid_fraction_profile_svg(const Case& c, const HeightProfile& p) {
  Plot plot = titled(c, "solid fraction of the box against height", "solid fraction [1]", "height z [mm]");
  plot.series.push_back(line("mean over the box", p.solid_fraction, p.z_mm));
  return svg_plot(plot);
}
}  // namespace venato::dem
