#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/rigs/discharge/rig.h"
#include "dem/rigs/support/statistics.h"

namespace venato::dem::rigs::discharge {
namespace {
const double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBlocks = 8, kFewestCrossings = 20;
double power(const Config& c) { return c.slot ? 1.5 : 2.5; }
/// What the law's flow is divided by to be a power of (D - k d): the length of a slot, less what its ends lose.
double length(const Config& c, double empty_m) { return c.slot ? c.slot_length_m - (c.slot_periodic ? 0 : empty_m) : 1; }
}  // namespace

double beverloo_kg_s(const Config& c, double size, double density, double gravity, double grain, double constant, double k) {
  const double open = size - k * grain;
  return open > 0 ? constant * density * std::sqrt(gravity) * length(c, k * grain) * std::pow(open, power(c)) : 0;
}

Flow flow_in_window(const std::vector<CounterRecord>& records, double from, double to) {
  std::array<double, kBlocks> block{};
  std::size_t crossings = 0;
  const double span = (to - from) / kBlocks;
  for (const CounterRecord& r : records) {
    if (!(r.time_s >= from && r.time_s < to)) continue;
    ++crossings;
    block[std::min(kBlocks - 1, static_cast<std::size_t>((r.time_s - from) / span))] += r.mass_kg / span;
  }
  if (crossings < kFewestCrossings) return {kNan, kNan, kNan};
  const Estimate all = mean_of(block), before_last = mean_of(std::span(block).first(kBlocks - 1));
  return {all.mean, all.standard_error, block.back() / before_last.mean};
}

BeverlooFit fit_beverloo(const Config& c, const std::vector<Flow>& flows, double density, double gravity, double grain) {
  std::vector<double> size, root, weight;
  const double p = power(c);
  for (std::size_t k = 0; k < flows.size(); ++k) {
    const double per_length = flows[k].mean_kg_s / length(c, kEmptyAnnulus * grain);
    const double relative = flows[k].standard_error_kg_s / flows[k].mean_kg_s;
    if (!(per_length > 0) || !(relative > 0)) continue;
    const double y = std::pow(per_length, 1 / p), error = relative / p * y;
    size.push_back(c.openings[k].size_m), root.push_back(y), weight.push_back(1 / (error * error));
  }
  if (size.size() < 3) return {kNan, kNan, kNan, kNan, kNan};
  const LineFit line = fit_line(size, root, weight, true);
  BeverlooFit fit{kNan, kNan, -line.intercept / line.slope, kNan, line.r2};
  const double a = line.intercept, s = line.slope;
  fit.empty_error_m = std::sqrt(line.intercept_error * line.intercept_error / (s * s) + a * a / std::pow(s, 4) * line.slope_error * line.slope_error -
                                2 * a / std::pow(s, 3) * line.covariance);
  if (density > 0) {
    fit.constant = std::pow(s, p) / (density * std::sqrt(gravity));
    fit.constant_error = fit.constant * p * line.slope_error / s;
  }
  return fit;
}

double bulk_density(const Snapshot& s, const Case& c, const Vec3& low, const Vec3& high) {
  double mass = 0;
  for (std::size_t k = 0; k < s.id.size(); ++k) {
    Vec3 at = s.position_m[k];
    for (int a = 0; a < 3; ++a)
      if (c.box.periodic[a]) {
        const double period = c.box.high[a] - c.box.low[a];
        at[a] -= std::floor((at[a] - c.box.low[a]) / period) * period;
      }
    if ((at.array() < low.array()).any() || (at.array() >= high.array()).any()) continue;
    const Powder& p = c.powders[static_cast<std::size_t>(s.species[k])];
    mass += c.materials.materials[static_cast<std::size_t>(p.material)].density_kg_m3 * 4 / 3 * std::numbers::pi *
            std::pow(static_cast<double>(s.radius_m[k]), 3);
  }
  return mass / (high - low).prod();
}
}  // namespace venato::dem::rigs::discharge
