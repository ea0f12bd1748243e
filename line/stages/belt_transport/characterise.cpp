#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unordered_map>

#include "base/error.h"
#include "base/rng.h"
#include "dem/fields/window_fields.h"
#include "line/products/operator_with_replicates.h"
#include "line/projection/open_stage.h"
#include "line/response/response_operator.h"
#include "line/stages/belt_transport/slice.h"

namespace venato::line::belt_transport {
namespace {
constexpr double kStart_s = 0.25;  // grains of the fresh fill are no witnesses

struct Layers {
  std::vector<double> zeta, mean_delay_s, sd_delay_s;
};

Layers layer_statistics(const ProjectionResult& p, int nz) {
  Layers l;
  std::vector<double> n(static_cast<std::size_t>(nz), 0.0), s(n), q(n);
  for (const TracerRecord& t : p.landed) {
    const auto k = static_cast<std::size_t>(std::clamp(static_cast<int>(t.zeta_out * nz), 0, nz - 1));
    n[k] += 1, s[k] += t.theta_s, q[k] += t.theta_s * t.theta_s;
  }
  for (std::size_t k = 0; k < n.size(); ++k) {
    l.zeta.push_back((static_cast<double>(k) + 0.5) / nz);
    l.mean_delay_s.push_back(n[k] > 0 ? s[k] / n[k] : std::nan(""));
    l.sd_delay_s.push_back(n[k] > 1 ? std::sqrt(std::max(0.0, q[k] / n[k] - s[k] / n[k] * s[k] / n[k])) : std::nan(""));
  }
  return l;
}

/// Independent of fields and projection: grains that the run itself carried from inlet to outlet. Only those that entered early enough for nearly all
/// to arrive count; the few of the bottom layer that are still on their way make the mean a little short. Returns {number, mean delay}.
std::pair<double, double> delay_of_grains(const dem::CaseResult& r, double latest_entry_s) {
  std::unordered_map<std::int64_t, double> entry;  // looked up by id only
  for (const dem::CounterRecord& g : r.records[0])
    if (g.time_s >= kStart_s && g.time_s <= latest_entry_s) entry.emplace(g.id, g.time_s);
  double n = 0, sum = 0;
  for (const dem::CounterRecord& g : r.records[1])
    if (const auto it = entry.find(g.id); it != entry.end()) n += 1, sum += g.time_s - it->second;
  return {n, n > 0 ? sum / n : std::nan("")};
}

/// Tracers carry equal shares of the flux, so the mass quantile of each is its rank. The field's own flux profile gives the same up to its defect of
/// continuity, but that defect can leave a layer exchange no scaling can balance. Returns the largest difference between the two.
double rank_quantiles(ProjectionResult& p) {
  const std::size_t n = p.landed.size();
  std::vector<std::size_t> order(n);
  double mismatch = 0;
  for (const auto member : {&TracerRecord::zeta_in, &TracerRecord::zeta_out}) {
    for (std::size_t k = 0; k < n; ++k) order[k] = k;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const double x = p.landed[a].*member, y = p.landed[b].*member;
      return x != y ? x < y : a < b;
    });
    for (std::size_t k = 0; k < n; ++k) {
      const double rank = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
      mismatch = std::max(mismatch, std::abs(p.landed[order[k]].*member - rank));
      p.landed[order[k]].*member = rank;
    }
  }
  return mismatch;
}

/// Moving blocks of frames drawn with replacement: weights per frame (multiscale.md 1.5).
std::vector<double> block_weights(std::size_t frames, std::size_t block, std::uint64_t seed, int replicate) {
  Rng rng(seed, stream_id("line/frame_bootstrap"), static_cast<std::uint64_t>(replicate));
  std::vector<double> w(frames, 0.0);
  const std::size_t draws = (frames + block - 1) / block;
  for (std::size_t d = 0; d < draws; ++d) {
    const std::size_t first = rng.below(frames - block + 1);
    for (std::size_t k = 0; k < block; ++k) w[first + k] += 1;
  }
  return w;
}
}  // namespace

Operator characterise(const Config& c, const LineBasics& basics, const std::filesystem::path& folder, Context& context) {
  const dem::Case slice = make_case(c, basics);
  const dem::CaseResult result = run_slice(slice, folder / "window.ckpt", context);
  const std::vector<dem::Snapshot>& frames = result.snapshots.at(0);
  const double cg = c.numerics.coarse_graining, grain = mean_grain_m(basics, basics.body_powder, cg);

  dem::FieldGrid grid;
  grid.cell_m = grain;
  grid.y0_m = -c.bin_m;
  grid.z0_m = -c.drop_m;
  grid.ny = static_cast<int>(std::ceil((outlet_y_m(c) + c.bin_m) / grid.cell_m));
  grid.nz = static_cast<int>(std::ceil((inlet_z_m(c, basics) + 1.5 * grid.cell_m + c.drop_m) / grid.cell_m));
  dem::FieldOptions field_options;
  field_options.slice_width_m = slice.box.high.x();
  field_options.coarse_graining = cg;
  const dem::WindowFields fields = dem::estimate_fields(frames, grid, field_options);
  const dem::StationarityReport steady = dem::check_stationarity(frames, grid);

  const double bed = c.gate_m;
  const Segment inlet{-c.bin_m, inlet_z_m(c, basics), 0, inlet_z_m(c, basics)};
  // The bed ends in a free slope at the end of the slice, about as long as it is high: it is read upstream of that slope, where it lies on the next
  // belt at full height.
  const double outlet_y = read_y_m(c);
  const Segment outlet{outlet_y, -c.drop_m, outlet_y, -c.drop_m + 1.6 * bed};
  ProjectionOptions projection;
  projection.grain_diameter_m = grain / cg;
  projection.max_time_s = 40 * (c.bin_m + outlet_y_m(c)) / basics.belt_speed_m_s;
  projection.steady_continuity = true;
  context.log.info("belt_transport: projecting tracers through the stationary fields");
  ProjectionResult best = project_open_stage(fields, inlet, outlet, c.tracers, projection, slice.seed, context.threads);
  const double quantile_mismatch = rank_quantiles(best);
  const int nz = basics.grid.nz;
  std::vector<std::vector<Landing>> sets{landings_of(best, nz, nz)};
  field_options.lag_s = fields.lag_s;  // the replicates answer for the noise of the fields, not for the choice of the lag
  const std::size_t block = std::max<std::size_t>(4, frames.size() / 8);
  for (int k = 0; k < basics.bootstrap_replicates; ++k) {
    if (context.stop_requested()) throw Interrupted("stopped while projecting tracers of belt_transport");
    field_options.frame_weights = block_weights(frames.size(), block, slice.seed, k);
    const dem::WindowFields drawn = dem::estimate_fields(frames, grid, field_options);
    ProjectionResult again =
        project_open_stage(drawn, inlet, outlet, c.tracers / 4, projection, slice.seed + static_cast<std::uint64_t>(k) + 1, context.threads);
    rank_quantiles(again);
    sets.push_back(landings_of(again, nz, nz));
  }
  const double dtheta = 0.5 * basics.grid.pitch_m / basics.belt_speed_m_s;
  Operator op = operator_with_replicates("belt_transport", sets, nz, nz, dtheta, basics.grid.pitch_m / 4, true);

  // Figures that justify the operator.
  op.figures["stationarity_velocity_change"] = steady.velocity_change;
  op.figures["stationarity_kinetic_energy_drift"] = steady.kinetic_energy_drift;
  op.figures["stationarity_height_drift"] = steady.height_drift;
  if (!steady.ok) {
    char text[240];
    std::snprintf(text, sizeof text,
                  "the DEM window is not stationary by the gate (between its halves: velocity %.1f %%, limit 5; kinetic energy %.1f %% and bed "
                  "height %.1f %%, limits 2): raise "
                  "settle_s or window_s",
                  100 * steady.velocity_change, 100 * steady.kinetic_energy_drift, 100 * steady.height_drift);
    op.warnings.emplace_back(text);
  }
  op.figures["quantile_mismatch"] = quantile_mismatch;
  op.figures["lag_s"] = fields.lag_s;
  op.figures["tracers_stuck_share"] = static_cast<double>(best.stuck) / best.tracers;
  op.figures["tracers_lost_share"] = static_cast<double>(best.lost) / best.tracers;
  if (best.stuck + best.lost > 0.02 * best.tracers)
    op.warnings.push_back(std::to_string(best.stuck + best.lost) + " of " + std::to_string(best.tracers) +
                          " tracers never reached the outlet (dead corner in the bin, or unseen cells)");
  double eta2 = 0, theta2 = 0;
  for (const TracerRecord& t : best.landed) eta2 += t.eta_m * t.eta_m;
  const Layers layers = layer_statistics(best, nz);
  for (const double s : layers.sd_delay_s) theta2 += s * s / nz;
  op.figures["blur_across_m"] = std::sqrt(eta2 / static_cast<double>(std::max<std::size_t>(1, best.landed.size())));
  op.figures["blur_along_m"] = std::sqrt(theta2) * basics.belt_speed_m_s;
  op.figures["top_minus_bottom_delay_s"] = layers.mean_delay_s.back() - layers.mean_delay_s.front();
  // Flux through the outlet as areal mass on the belt: what the gate lays.
  const double density = basics.powders[static_cast<std::size_t>(basics.body_powder)].granule_density_kg_m3;
  op.figures["areal_mass_kg_m2"] = best.outlet_flux_m2_s * density / basics.belt_speed_m_s;
  op.figures["flux_defect"] = best.outlet_flux_m2_s > 0 ? best.inlet_flux_m2_s / best.outlet_flux_m2_s - 1 : std::nan("");
  const auto [carried, delay] = delay_of_grains(result, slice.duration_s - 1.4 * op.reference_delay_s);
  op.figures["grains_carried_through"] = carried;
  op.figures["delay_of_grains_s"] = delay;
  op.curves["delay of each layer"] = {{"zeta", layers.zeta}, {"mean_delay_s", layers.mean_delay_s}, {"sd_delay_s", layers.sd_delay_s}};

  // Profiles across the bed at the middle of the next belt.
  const int column = static_cast<int>((outlet_y - grid.y0_m) / grid.cell_m);
  std::vector<double> height, velocity, fraction, diffusivity;
  for (int j = 0; j < grid.nz; ++j) {
    const std::size_t at = grid.index(column, j);
    if (fields.solid_fraction[at] <= 0) continue;
    height.push_back((grid.z0_m + (j + 0.5) * grid.cell_m + c.drop_m) * 1e3);
    velocity.push_back(fields.velocity_y_m_s[at]);
    fraction.push_back(fields.solid_fraction[at]);
    diffusivity.push_back(fields.d_zz_m2_s[at] * 1e6);
  }
  op.curves["profiles on the next belt"] = {
      {"height_mm", height}, {"velocity_m_s", velocity}, {"solid_fraction", fraction}, {"diffusivity_mm2_s", diffusivity}};
  add_slice_figures(slice, result, op);
  warn_if_too_coarse(basics, basics.body_powder, c.numerics, "levelling gate", c.gate_m, op.warnings);
  return op;
}
}  // namespace venato::line::belt_transport
