/// Where grains of a case come from: fills, rain, hand-over.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"
#include "dem/run_case_state.h"

namespace venato::dem {
namespace {
constexpr std::int64_t kInsertEvery = 64;    // steps between insertions of rain: each one costs a list build
constexpr std::int64_t kHandOverEvery = 10;  // grains handed over are few and their birth time matters
constexpr int kAttempts = 30;                // random places tried for one grain before it waits for the next time
constexpr double kGap = 0.02;                // of a diameter, between neighbours of a fresh fill
constexpr double kHandOverSqueeze = 0.05;    // overlap of radius that a handed-over grain may start with

bool active(const std::vector<Interval>& when, double t) {
  return when.empty() || std::any_of(when.begin(), when.end(), [t](const Interval& i) { return t >= i.on_s && t < i.off_s; });
}

/// Loose block: shelves. Grains stand in rows along x, rows side by side along y, layers on top of each other; a row is as wide and a layer as high
/// as its largest grain. The places are as random as the sizes; the spare height of a layer jitters the rest.
void fill_region(CaseRun& run, const Fill& fill, std::size_t index) {
  const Case& c = run.c;
  GrainStream stream(c, fill.powder_mass_fractions, stream_id("dem/fill") + index);
  const bool others = run.sim.grain_count() > 0;
  const Vec3 size = fill.high - fill.low;
  if ((size.array() < stream.largest_diameter_m()).any())
    throw UsageError("DEM case '" + c.name + "': fill " + std::to_string(index) + " is smaller than its largest grain (" +
                     std::to_string(stream.largest_diameter_m() * 1e3) + " mm)");
  const bool wanted_all = fill.mass_kg > 0;
  std::uint64_t entity = 0;
  double placed_kg = 0;
  bool full = false;
  auto enough = [&] { return wanted_all && placed_kg + 0.5 * stream.at(entity).mass_kg >= fill.mass_kg; };
  struct Site {
    GrainStream::Draw draw;
    std::uint64_t entity;
    double x, y;
  };
  for (double z = 0; !full && !enough();) {
    std::vector<Site> layer;  // one layer, laid out in x and y before its height is known
    double layer_height = 0, layer_kg = 0;
    std::uint64_t next = entity;
    auto layer_enough = [&] { return wanted_all && placed_kg + layer_kg + 0.5 * stream.at(next).mass_kg >= fill.mass_kg; };
    for (double y = 0; !layer_enough();) {
      double x = 0, row_width = 0;
      const std::size_t row_start = layer.size();
      const double height_before = layer_height, kg_before = layer_kg;
      const std::uint64_t next_before = next;
      for (; !layer_enough();) {
        const GrainStream::Draw d = stream.at(next);
        const double pitch = (1 + kGap) * d.diameter_m;
        if (x + pitch > size.x()) break;
        layer.push_back({d, next, x + 0.5 * pitch, y});
        x += pitch, row_width = std::max(row_width, pitch), layer_height = std::max(layer_height, pitch), layer_kg += d.mass_kg;
        ++next;
      }
      if (y + row_width > size.y() || layer.size() == row_start) {  // the row does not fit: undo it, the layer is complete
        layer.resize(row_start), layer_height = height_before, layer_kg = kg_before, next = next_before;
        break;
      }
      for (std::size_t k = row_start; k < layer.size(); ++k) layer[k].y += 0.5 * row_width;
      y += row_width;
    }
    if (layer.empty() || z + layer_height > size.z()) {
      full = true;
      break;
    }
    for (const Site& s : layer) {
      Rng rng(c.seed, stream_id("dem/fill/jitter") + index, s.entity);
      const double spare = layer_height - (1 + kGap) * s.draw.diameter_m;
      const Vec3 at = fill.low + Vec3(s.x, s.y, z + 0.5 * layer_height + spare * (rng.uniform() - 0.5));
      const double radius = 0.5 * s.draw.diameter_m;
      if (run.sim.wall_gap_m(at, radius) < 0 || (others && !run.sim.is_free(at, radius))) continue;  // a wall or an earlier grain stands there
      run.put_in(grain_of(s.draw, at, fill.velocity_m_s), s.draw.mass_kg);
      placed_kg += s.draw.mass_kg;
    }
    entity = next;
    z += layer_height;
  }
  if (wanted_all && full && !enough())
    throw UsageError("DEM case '" + c.name + "': fill " + std::to_string(index) + " holds " + std::to_string(placed_kg * 1e3) + " g of the " +
                     std::to_string(fill.mass_kg * 1e3) + " g asked for; give it a larger region");
}

void rain(CaseRun& run, std::size_t index) {
  const Rain& r = run.c.rains[index];
  RainState& state = run.rains[index];
  GrainStream& stream = run.rain_streams[index];
  const double t = run.sim.time_s();
  if (!active(r.when, t)) return;
  if (!std::isnan(r.level_z_m) && run.sim.bed_top_m(r.low, r.high, r.resting_speed_m_s) >= r.level_z_m) return;
  state.due_kg += r.mass_rate_kg_s * static_cast<double>(kInsertEvery) * run.sim.time_step_s();
  while (true) {
    const GrainStream::Draw d = stream.at(state.entity);
    if (state.due_kg < 0.5 * d.mass_kg) return;
    const double radius = 0.5 * d.diameter_m;
    Rng rng(run.c.seed, stream_id("dem/rain/place") + index, state.entity, static_cast<std::uint64_t>(run.sim.step_number()));
    bool placed = false;
    for (int k = 0; k < kAttempts && !placed; ++k) {
      Vec3 at;
      for (int a = 0; a < 3; ++a) {
        const bool room = !run.c.box.periodic[a] && r.high[a] - r.low[a] > 2 * radius;  // whole grains inside the region where it has room
        const double low = r.low[a] + (room ? radius : 0), high = r.high[a] - (room ? radius : 0);
        at[a] = low + rng.uniform() * (high - low);
      }
      if (!run.sim.is_free(at, radius) || run.sim.wall_gap_m(at, radius) < 0) continue;
      run.put_in(grain_of(d, at, r.velocity_m_s), d.mass_kg);
      placed = true;
    }
    if (!placed) return;  // stays due: retried next time, counted as starved at the end
    state.due_kg -= d.mass_kg;
    ++state.entity;
  }
}

void hand_over(CaseRun& run) {
  std::size_t kept = 0, k = 0;
  for (; k < run.waiting.size(); ++k) {
    const GrainRecord& g = run.c.handed_over[run.waiting[k]];
    if (g.time_s > run.sim.time_s()) break;
    if (!run.sim.is_free(g.position_m, (1 - kHandOverSqueeze) * 0.5 * g.diameter_m)) {
      ++run.delayed_hand_overs;
      run.waiting[kept++] = run.waiting[k];
      continue;
    }
    const Powder& p = run.c.powders[static_cast<std::size_t>(g.species)];
    const double density = run.c.materials.materials[static_cast<std::size_t>(p.material)].density_kg_m3;
    GrainStream::Draw d{g.diameter_m, density * std::numbers::pi / 6 * g.diameter_m * g.diameter_m * g.diameter_m, g.species, p.material};
    GrainInput in = grain_of(d, g.position_m, g.velocity_m_s);
    in.spin_rad_s = g.spin_rad_s;
    run.put_in(in, d.mass_kg);
  }
  if (kept != k) {
    std::copy(run.waiting.begin() + static_cast<std::ptrdiff_t>(k), run.waiting.end(), run.waiting.begin() + static_cast<std::ptrdiff_t>(kept));
    run.waiting.resize(run.waiting.size() - (k - kept));
  }
}
}  // namespace

GrainInput grain_of(const GrainStream::Draw& d, const Vec3& position, const Vec3& velocity) {
  GrainInput g;
  g.position_m = position;
  g.velocity_m_s = velocity;
  g.radius_m = 0.5 * d.diameter_m;
  g.species = d.species;
  g.material = d.material;
  return g;
}

GrainStream::GrainStream(const Case& c, const std::vector<double>& fractions, std::uint64_t stream) : case_(&c), stream_(stream) {
  double sum = 0;
  for (std::size_t k = 0; k < c.powders.size(); ++k) {
    if (fractions[k] > 0) {
      const Powder& p = c.powders[k];
      sum += fractions[k] / mean_grain_mass(p.psd, c.materials.materials[static_cast<std::size_t>(p.material)].density_kg_m3, c.coarse_graining);
      largest_m_ = std::max(largest_m_, p.psd.upper_cut_m * c.coarse_graining);
    }
    by_number_.push_back(sum);
  }
  for (double& n : by_number_) n /= sum;
}

GrainStream::Draw GrainStream::at(std::uint64_t entity) {
  if (entity / kChunk != chunk_) {
    chunk_ = entity / kChunk;
    diameter_m_.clear();
    for (std::size_t k = 0; k < case_->powders.size(); ++k)
      diameter_m_.push_back(sample_diameters(case_->powders[k].psd, case_->coarse_graining, kChunk, case_->seed, stream_ * 31 + 7, chunk_ * kChunk));
  }
  Rng rng(case_->seed, stream_, entity);
  const double u = rng.uniform();
  std::size_t k = 0;
  while (k + 1 < by_number_.size() && u >= by_number_[k]) ++k;
  const Powder& p = case_->powders[k];
  const double d = diameter_m_[k][entity % kChunk];
  const double density = case_->materials.materials[static_cast<std::size_t>(p.material)].density_kg_m3;
  return {d, density * std::numbers::pi / 6 * d * d * d, static_cast<int>(k), p.material};
}

GrainId CaseRun::put_in(const GrainInput& grain, double mass_kg) {
  GrainInput g = grain;
  g.mass_kg = mass_kg;
  const GrainId id = sim.insert_free_grain(g);
  births.push_back({sim.time_s(), grain.position_m});
  for (auto& s : seen) s.push_back(0);
  result.mass_put_in_kg += mass_kg;
  return id;
}

void CaseRun::take_out(GrainId id, double& account) {
  account += sim.grain(id).mass_kg;
  sim.remove_grain(id);
}

void fill_regions(CaseRun& run) {
  for (std::size_t k = 0; k < run.c.fills.size(); ++k) {
    const Fill& fill = run.c.fills[k];
    fill.solid_fraction > 0 ? fill_dense(run, fill, k) : fill_region(run, fill, k);
  }
}

void rain_and_hand_over(CaseRun& run) {
  if (run.sim.step_number() % kHandOverEvery == 0) hand_over(run);
  if (run.sim.step_number() % kInsertEvery != 0) return;
  for (std::size_t k = 0; k < run.c.rains.size(); ++k) rain(run, k);
}
}  // namespace venato::dem
