#include <cmath>
#include <numbers>

#include "base/error.h"
#include "dem/fields/mean_flow.h"
#include "dem/fields/window_fields.h"

namespace venato::dem {
namespace {
// Gates of multiscale.md 1.5.
constexpr double kVelocityChange = 0.05, kVelocitySigmas = 3, kDrift = 0.02;
constexpr std::size_t kBlocks = 8;  // time blocks for the standard error; half of them in each half of the window
constexpr double kMinSamples = 50;  // per half window and cell
// Mean of |N(0, 1)|: what the L1 change of a stationary window is expected to be, in standard errors.
const double kMeanAbsNormal = std::sqrt(2 / std::numbers::pi);

double cubed(float r) {
  const auto x = static_cast<double>(r);
  return x * x * x;
}

/// Volume-weighted means over the frames of one half: kinetic energy sum per frame, height of the centre of mass above the grid's foot.
struct Bulk {
  double kinetic = 0, height_m = 0;
};
Bulk bulk_of(std::span<const Snapshot> frames, const FieldGrid& grid) {
  Bulk bulk;
  double volume = 0;
  for (const Snapshot& frame : frames)
    for (std::size_t k = 0; k < frame.id.size(); ++k) {
      const double v = cubed(frame.radius_m[k]);
      bulk.kinetic += v * frame.velocity_m_s[k].squaredNorm() / static_cast<double>(frames.size());
      bulk.height_m += v * (frame.position_m[k].z() - grid.z0_m);
      volume += v;
    }
  bulk.height_m = volume > 0 ? bulk.height_m / volume : 0;
  return bulk;
}

double drift(double first, double second) {
  const double mean = 0.5 * (std::abs(first) + std::abs(second));
  return mean > 0 ? std::abs(second - first) / mean : 0;
}

/// Mean flow of frames [from, to], and nothing masked but empty cells when it is one of the blocks.
MeanFlow flow_between(std::span<const Snapshot> frames, std::size_t from, std::size_t to, const FieldGrid& grid, bool periodic_y,
                      double min_samples) {
  const auto part = frames.subspan(from, to - from + 1);
  std::vector<double> times;
  for (const Snapshot& frame : part) times.push_back(frame.time_s);
  return mean_flow(make_tracks(part), times, std::vector<double>(part.size(), 1.0), grid, periodic_y, min_samples);
}
}  // namespace

StationarityReport check_stationarity(std::span<const Snapshot> frames, const FieldGrid& grid, bool periodic_y) {
  if (frames.size() < kBlocks + 1) throw UsageError("the stationarity gate needs at least 9 frames, has " + std::to_string(frames.size()));
  const std::size_t steps = frames.size() - 1, middle = steps / 2;
  const MeanFlow first = flow_between(frames, 0, middle, grid, periodic_y, kMinSamples),
                 second = flow_between(frames, middle, steps, grid, periodic_y, kMinSamples);
  std::vector<MeanFlow> blocks;
  for (std::size_t b = 0; b < kBlocks; ++b)
    blocks.push_back(flow_between(frames, b * steps / kBlocks, (b + 1) * steps / kBlocks, grid, periodic_y, 1));

  double change = 0, speed = 0, noise = 0;
  for (std::size_t c = 0; c < grid.size(); ++c) {
    if (!first.known(c) || !second.known(c)) continue;
    const double w = first.weight[c] + second.weight[c];
    double variance = 0;  // of a block's velocity about its own half, so that a drift between the halves does not count as noise
    int n = 0;
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const MeanFlow& half = b < kBlocks / 2 ? first : second;
      if (!blocks[b].known(c)) continue;
      variance += std::pow(blocks[b].u_y_m_s[c] - half.u_y_m_s[c], 2) + std::pow(blocks[b].u_z_m_s[c] - half.u_z_m_s[c], 2);
      ++n;
    }
    change += w * std::hypot(second.u_y_m_s[c] - first.u_y_m_s[c], second.u_z_m_s[c] - first.u_z_m_s[c]);
    speed += w * 0.5 * (std::hypot(first.u_y_m_s[c], first.u_z_m_s[c]) + std::hypot(second.u_y_m_s[c], second.u_z_m_s[c]));
    // n - 2 degrees of freedom for the two means; the difference of two means of n/2 blocks each has variance 4 s^2 / n.
    if (n > 2) noise += w * kMeanAbsNormal * std::sqrt(variance / (n - 2) * 4 / n);
  }
  StationarityReport report{};
  report.velocity_change = speed > 0 ? change / speed : 0;
  report.velocity_change_sigmas = noise > 0 ? change / noise : (change > 0 ? 1e9 : 0);
  const Bulk a = bulk_of(frames.subspan(0, middle), grid), b = bulk_of(frames.subspan(middle), grid);
  report.kinetic_energy_drift = drift(a.kinetic, b.kinetic);
  report.height_drift = drift(a.height_m, b.height_m);
  report.ok = speed > 0 && (report.velocity_change < kVelocityChange || report.velocity_change_sigmas < kVelocitySigmas) &&
              report.kinetic_energy_drift < kDrift && report.height_drift < kDrift;
  return report;
}
}  // namespace venato::dem
