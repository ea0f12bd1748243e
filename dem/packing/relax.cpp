#include "dem/packing/relax.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace venato::dem {
namespace {
// The authors' values; time in units of sqrt(m / k) = 1. A sphere in twelve contacts swings with omega = sqrt(8): steps up to 0.7 are stable.
constexpr std::int64_t kDelay = 5;
constexpr double kSpeedUp = 1.1, kSlowDown = 0.5, kFirstMix = 0.1, kMixDecay = 0.99, kFirstStep = 0.1, kLongestStep = 0.5;
constexpr std::int64_t kWindow = 400;

/// Iterations until the energy has fallen as far as the overlaps must (energy ~ overlap^2), at the pace of the last window.
double iterations_to_go(double energy_before, double energy_now, double overlap_ratio) {
  const double pace = std::log(energy_before / energy_now) / kWindow;  // <= 0 or not a number: never
  return pace > 0 ? 2 * std::log(overlap_ratio) / pace : std::numeric_limits<double>::infinity();
}
}  // namespace

RelaxReport relax(SoftSpheres& spheres, const RelaxLimits& limits) {
  RelaxReport report;
  double dt = kFirstStep, mix = kFirstMix, energy_before = 0;
  std::int64_t downhill = 0;
  for (;; ++report.iterations) {
    const SoftSpheres::Sums s = spheres.evaluate();
    report.max_overlap = std::max(0.0, s.max_overlap);
    report.energy = s.energy;
    report.reached = s.max_overlap <= limits.max_overlap;
    report.balanced = limits.balance > 0 && s.force2 <= limits.balance * 4 * s.energy;  // each pair counts for both of its spheres
    if (report.reached || report.balanced || report.iterations >= limits.most_iterations) return report;
    if (report.iterations % kWindow == 0) {
      if (limits.balance <= 0 && report.iterations > 0 &&
          iterations_to_go(energy_before, s.energy, s.max_overlap / limits.max_overlap) > static_cast<double>(limits.most_iterations))
        return report;
      energy_before = s.energy;
    }
    double keep = 1, turn = 0;
    if (s.power > 0) {
      keep = 1 - mix, turn = mix * std::sqrt(s.velocity2 / s.force2);
      if (++downhill > kDelay) dt = std::min(kSpeedUp * dt, kLongestStep), mix *= kMixDecay;
    } else {
      keep = 0, downhill = 0;
      if (report.iterations > 0) dt *= kSlowDown;
      mix = kFirstMix;
    }
    spheres.move(dt, keep, turn);
  }
}
}  // namespace venato::dem
