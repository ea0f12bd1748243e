/// Dense fills: a random packing of the region, less what does not fit beside walls and earlier grains.
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"
#include "dem/packing/pack_dense.h"
#include "dem/run_case_state.h"

namespace venato::dem {
namespace {
constexpr double kSameFace = 1e-9;  // of the box length: the region spans a periodic box

Box region_box(const Case& c, const Fill& fill) {
  Box box{fill.low, fill.high, {false, false, false}};
  for (int a = 0; a < 3; ++a) {
    const double length = c.box.high[a] - c.box.low[a];
    box.periodic[a] = c.box.periodic[a] && fill.high[a] - fill.low[a] > (1 - kSameFace) * length;
  }
  return box;
}

std::vector<GrainStream::Draw> grains_of_volume(GrainStream& stream, double volume_m3) {
  std::vector<GrainStream::Draw> draws;
  for (double sum = 0;;) {
    const GrainStream::Draw d = stream.at(draws.size());
    const double v = std::numbers::pi / 6 * d.diameter_m * d.diameter_m * d.diameter_m;
    if (sum + 0.5 * v >= volume_m3) return draws;  // nearest whole number of grains
    draws.push_back(d);
    sum += v;
  }
}
}  // namespace

void fill_dense(CaseRun& run, const Fill& fill, std::size_t index) {
  const std::string who = "DEM case '" + run.c.name + "': fill " + std::to_string(index) + ": ";
  GrainStream stream(run.c, fill.powder_mass_fractions, stream_id("dem/fill/dense/grains") + index);
  const std::vector<GrainStream::Draw> draws = grains_of_volume(stream, fill.solid_fraction * (fill.high - fill.low).prod());
  if (draws.empty()) throw UsageError(who + "its region is too small for a single grain at this solid fraction");
  std::vector<double> radii;
  for (const auto& d : draws) radii.push_back(0.5 * d.diameter_m);

  PackingOptions options;
  options.max_overlap = kDenseFillOverlap;
  options.seed = run.c.seed;
  options.stream = stream_id("dem/fill/dense/places") + index;
  options.threads = run.sim.threads();
  std::vector<Vec3> at;
  try {
    at = pack_dense(region_box(run.c, fill), radii, options).position_m;
  } catch (const UsageError& e) {
    throw UsageError(who + e.what());
  }

  // Looked at before any of them is put in: they touch each other.
  const bool others = run.sim.grain_count() > 0;
  std::vector<std::uint8_t> fits(draws.size());
  for (std::size_t k = 0; k < draws.size(); ++k)
    fits[k] = run.sim.wall_gap_m(at[k], radii[k]) >= -kDenseFillOverlap * radii[k] &&
              (!others || run.sim.is_free(at[k], (1 - kDenseFillOverlap) * radii[k]));
  for (std::size_t k = 0; k < draws.size(); ++k)
    if (fits[k]) run.put_in(grain_of(draws[k], at[k], fill.velocity_m_s), draws[k].mass_kg);
}
}  // namespace venato::dem
