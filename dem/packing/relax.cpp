#include "dem/packing/relax.h"

#include <algorithm>
#include <cmath>

namespace venato::dem {
namespace {
// The authors' values; time in units of sqrt(m / k) = 1. A sphere in twelve contacts swings with omega = sqrt(8): steps up to 0.7 are stable.
constexpr std::int64_t kDelay = 5;
constexpr double kSpeedUp = 1.1, kSlowDown = 0.5, kFirstMix = 0.1, kMixDecay = 0.99, kFirstStep = 0.1, kLongestStep = 0.5;
constexpr std::int64_t kStuckWindow = 200;
}  // namespace

RelaxReport relax(SoftSpheres& spheres, const RelaxLimits& limits) {
  RelaxReport report;
  double dt = kFirstStep, mix = kFirstMix, lowest = 0, lowest_before = 0;
  std::int64_t downhill = 0;
  for (;; ++report.iterations) {
    const SoftSpheres::Sums s = spheres.evaluate();
    report.max_overlap = std::max(0.0, s.max_overlap);
    report.energy = s.energy;
    report.reached = s.max_overlap <= limits.max_overlap;
    if (report.reached || report.iterations >= limits.most_iterations || !(s.force2 > 0)) return report;
    lowest = report.iterations == 0 ? s.energy : std::min(lowest, s.energy);
    if (report.iterations % kStuckWindow == 0) {
      if (report.iterations > 0 && lowest > (1 - limits.stuck_fraction) * lowest_before) return report;
      lowest_before = lowest;
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
