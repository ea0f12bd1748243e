#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "dem/psd/check_sizes.h"
#include "dem/run_case.h"

namespace venato::dem {
namespace {
// configs/dem/slot_hopper.json (4500 grains, filling, rest and discharge): 9.7e6 per core second on a shared 2020s server core; beds of 100,000 and a
// million grains 8e6 to 13e6 (tests/bench/RESULTS.md). Used for estimates only, never for results.
constexpr double kParticleStepsPerCoreSecond = 8e6;
// State, lists, histories, and what building a list needs (800 to 940 measured): tests/bench/RESULTS.md.
constexpr double kBytesPerGrain = 1000;
constexpr double kBytesPerSnapshotGrain = 8 + 24 + 24 + 4 + 4;
constexpr double kBytesPerCounterRecord = 160;
constexpr double kLatticePitch = 1.02;  // diameters per place of a loose row

/// Grains per kg of a powder mixture.
double grains_per_kg(const Case& c, const std::vector<double>& fractions) {
  double n = 0;
  for (std::size_t k = 0; k < c.powders.size() && k < fractions.size(); ++k) {
    if (!(fractions[k] > 0)) continue;
    const Powder& p = c.powders[k];
    const Material& m = c.materials.materials.at(static_cast<std::size_t>(p.material));
    n += fractions[k] / mean_grain_mass(p.psd, m.density_kg_m3, c.coarse_graining);
  }
  return n;
}

/// Grains of a dense fill, if no wall stands in its region.
double dense_grains(const Case& c, const Fill& fill) {
  double volume_per_kg = 0;
  for (std::size_t k = 0; k < c.powders.size() && k < fill.powder_mass_fractions.size(); ++k)
    volume_per_kg += fill.powder_mass_fractions[k] / c.materials.materials.at(static_cast<std::size_t>(c.powders[k].material)).density_kg_m3;
  return volume_per_kg > 0 ? fill.solid_fraction * (fill.high - fill.low).prod() / volume_per_kg * grains_per_kg(c, fill.powder_mass_fractions) : 0;
}

/// Fills are packed in rows along x (each as wide as its largest grain) and layers (as high as theirs).
double lattice_grains(const Case& c, const Fill& fill) {
  double largest = 0, volume_per_kg = 0;  // of the powders in the mixture
  for (std::size_t k = 0; k < c.powders.size() && k < fill.powder_mass_fractions.size(); ++k) {
    if (!(fill.powder_mass_fractions[k] > 0)) continue;
    const Powder& p = c.powders[k];
    largest = std::max(largest, p.psd.upper_cut_m * c.coarse_graining);
    volume_per_kg += fill.powder_mass_fractions[k] / c.materials.materials.at(static_cast<std::size_t>(p.material)).density_kg_m3;
  }
  const double grains = grains_per_kg(c, fill.powder_mass_fractions);
  if (!(largest > 0) || !(grains > 0)) return 0;
  const double mean = std::cbrt(6 / std::numbers::pi * volume_per_kg / grains);  // diameter of the mean grain volume
  const Vec3 size = fill.high - fill.low;
  // The widest of a row of ten or twenty grains lies about half-way (in ln d) between the mean and the largest of all; a layer holds one of the
  // largest.
  const Vec3 place = kLatticePitch * Vec3(mean, std::sqrt(mean * largest), largest);
  return std::max(1.0, size.x() / place.x()) * std::max(1.0, size.y() / place.y()) * std::max(1.0, size.z() / place.z());
}

struct GrainCount {
  double last = 0, integral = 0;  // grains present at the end, and their time integral [s], if nothing left the case
};

void add_from(GrainCount& count, double grains, double birth_s, double duration_s) {
  if (birth_s >= duration_s) return;
  count.last += grains;
  count.integral += grains * (duration_s - std::max(0.0, birth_s));
}

void add_rain(GrainCount& count, const Case& c, const Rain& rain) {
  const double rate = rain.mass_rate_kg_s * grains_per_kg(c, rain.powder_mass_fractions);
  const std::vector<Interval> always{{0, c.duration_s}};
  for (const Interval& on : rain.when.empty() ? always : rain.when) {
    const double from = std::clamp(on.on_s, 0.0, c.duration_s), to = std::clamp(on.off_s, from, c.duration_s);
    count.last += rate * (to - from);
    count.integral += rate * (to - from) * (c.duration_s - 0.5 * (from + to));
  }
}
}  // namespace

CaseCost estimate_cost(const Case& c, int threads) {
  if (!(c.duration_s > 0)) throw UsageError("case '" + c.name + "': duration_s must be > 0");
  const double step = choose_time_step(c);  // also checks materials and sizes
  GrainCount count;
  for (const Fill& fill : c.fills) {
    const double holds = fill.solid_fraction > 0 ? dense_grains(c, fill) : lattice_grains(c, fill);
    const double n = fill.mass_kg > 0 ? fill.mass_kg * grains_per_kg(c, fill.powder_mass_fractions) : holds;
    add_from(count, n, 0, c.duration_s);
  }
  for (const Rain& rain : c.rains) add_rain(count, c, rain);
  for (const GrainRecord& grain : c.handed_over) add_from(count, 1, grain.time_s, c.duration_s);

  CaseCost cost{};
  cost.particles = count.last;
  cost.steps = std::ceil(c.duration_s / step);
  cost.particle_steps = count.integral / step;
  double frames = 0;
  for (const SnapshotPlan& plan : c.snapshots)
    if (plan.every_s > 0) frames += std::max(0.0, std::floor((std::min(plan.to_s, c.duration_s) - plan.from_s) / plan.every_s) + 1);
  cost.memory_bytes =
      cost.particles * (kBytesPerGrain + frames * kBytesPerSnapshotGrain + static_cast<double>(c.counters.size()) * kBytesPerCounterRecord);
  cost.seconds = cost.particle_steps / (kParticleStepsPerCoreSecond * std::max(1, threads));
  return cost;
}
}  // namespace venato::dem
