#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "dem/fields/diffusivity.h"
#include "dem/fields/window_fields.h"

namespace venato::dem {
namespace {
void check_input(std::span<const Snapshot> frames, const FieldGrid& grid, const FieldOptions& options) {
  if (frames.size() < 3) throw UsageError("fields need at least 3 frames, have " + std::to_string(frames.size()));
  for (std::size_t f = 1; f < frames.size(); ++f)
    if (!(frames[f].time_s > frames[f - 1].time_s)) throw UsageError("fields: frame " + std::to_string(f) + " is not later than the one before");
  if (grid.ny < 1 || grid.nz < 1 || !(grid.cell_m > 0)) throw UsageError("fields: the grid needs ny, nz >= 1 and a cell > 0");
  if (!(options.slice_width_m > 0)) throw UsageError("fields: slice_width_m must be > 0");
  if (!(options.coarse_graining > 0)) throw UsageError("fields: coarse_graining must be > 0");
  if (!options.frame_weights.empty() && options.frame_weights.size() != frames.size())
    throw UsageError("fields: " + std::to_string(options.frame_weights.size()) + " frame weights for " + std::to_string(frames.size()) + " frames");
}

/// Grain volume spread cloud-in-cell over the four cells around the centre, per cell volume and weighted frame.
std::vector<double> solid_fraction(std::span<const Snapshot> frames, std::span<const double> weights, const FieldGrid& grid,
                                   const FieldOptions& options) {
  const GridLookup lookup(grid, options.periodic_y);
  std::vector<double> volume(grid.size(), 0);
  double total_weight = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    total_weight += weights[f];
    for (std::size_t k = 0; k < frames[f].id.size(); ++k) {
      const Vec3& x = frames[f].position_m[k];
      if (!lookup.cell(x.y(), x.z())) continue;
      const auto r = static_cast<double>(frames[f].radius_m[k]);
      const double v = weights[f] * 4.0 / 3 * std::numbers::pi * r * r * r;
      const auto corners = lookup.corners(x.y(), x.z());
      for (std::size_t q = 0; q < 4; ++q) volume[corners.cell[q]] += v * corners.weight[q];
    }
  }
  if (!(total_weight > 0)) throw UsageError("fields: all frame weights are 0");
  for (double& v : volume) v /= total_weight * grid.cell_m * grid.cell_m * options.slice_width_m;
  return volume;
}

std::size_t frames_of_lag(double lag_s, std::span<const double> times) {
  const double interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  return static_cast<std::size_t>(std::max(1.0, std::round(lag_s / interval)));
}

/// Chosen lag and its sums.
std::pair<std::size_t, DiffusivitySums> diffusivity(const Tracks& tracks, std::span<const double> times, std::span<const double> weights,
                                                    const MeanFlow& mean, const FieldGrid& grid, const FieldOptions& options) {
  const IntegratedFlow flow = integrated_flow(tracks, times, mean, grid, options.periodic_y);
  const auto sums_of = [&](std::size_t lag) { return diffusivity_sums(tracks, flow, times, weights, mean, grid, options.periodic_y, lag); };
  // A stretch longer than half the window leaves fewer than two independent ones.
  const std::size_t longest = std::max<std::size_t>(1, (times.size() - 1) / 2);
  if (options.lag_s > 0) {
    const std::size_t lag = std::min(longest, frames_of_lag(options.lag_s, times));
    return {lag, sums_of(lag)};
  }
  const std::vector<std::size_t> lags = candidate_lags(std::min(longest, frames_of_lag(options.max_lag_s, times)));
  std::vector<double> traces;
  for (std::size_t lag : lags) traces.push_back(sums_of(lag).mean_trace());
  const std::size_t lag = lags[smallest_plateau_lag(lags, traces)];
  return {lag, sums_of(lag)};
}
}  // namespace

WindowFields estimate_fields(std::span<const Snapshot> frames, const FieldGrid& grid, const FieldOptions& options) {
  check_input(frames, grid, options);
  std::vector<double> times, weights = options.frame_weights;
  for (const Snapshot& frame : frames) times.push_back(frame.time_s);
  if (weights.empty()) weights.assign(frames.size(), 1.0);

  const Tracks tracks = make_tracks(frames);
  MeanFlow mean = mean_flow(tracks, times, weights, grid, options.periodic_y, options.min_samples);
  const auto [lag, sums] = diffusivity(tracks, times, weights, mean, grid, options);

  WindowFields fields;
  fields.grid = grid;
  fields.coarse_graining = options.coarse_graining;
  fields.lag_s = static_cast<double>(lag) * (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  fields.solid_fraction = solid_fraction(frames, weights, grid, options);
  for (auto* d : {&fields.d_xx_m2_s, &fields.d_yy_m2_s, &fields.d_zz_m2_s, &fields.d_yz_m2_s}) d->assign(grid.size(), 0);
  const double cg2 = options.coarse_graining * options.coarse_graining;
  for (std::size_t c = 0; c < grid.size(); ++c) {
    if (!mean.known(c) || !(sums.weight[c] > 0)) {
      fields.solid_fraction[c] = mean.u_y_m_s[c] = mean.u_z_m_s[c] = 0;
      continue;
    }
    const double scale = 1 / (sums.weight[c] * cg2);
    fields.d_xx_m2_s[c] = sums.xx[c] * scale;
    fields.d_yy_m2_s[c] = sums.yy[c] * scale;
    fields.d_zz_m2_s[c] = sums.zz[c] * scale;
    fields.d_yz_m2_s[c] = sums.yz[c] * scale;
  }
  fields.velocity_y_m_s = std::move(mean.u_y_m_s);
  fields.velocity_z_m_s = std::move(mean.u_z_m_s);
  fields.samples = std::move(mean.samples);
  return fields;
}
}  // namespace venato::dem
