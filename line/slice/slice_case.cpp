#include "line/slice/slice_case.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "base/units.h"
#include "dem/coarse_graining/openings.h"

namespace venato::line {

void read_slice_numerics(ObjectReader& r, SliceNumerics& n, double default_coarse_graining, double default_width_mm, double default_max_speed_m_s) {
  r.number("coarse_graining", n.coarse_graining, {1, 20, "", "beyond 20 a slice holds too few grains"},
           {.help = "grain diameters in the DEM slice are this factor larger than the powder's", .fallback = default_coarse_graining});
  r.number("slice_width_mm", n.slice_width_m, {1, 100, "mm"},
           {.help = "periodic width of the DEM slice across the belt; at least two largest coarse grains", .fallback = default_width_mm});
  r.number(
      "expected_max_speed_m_s", n.expected_max_speed_m_s, {0.01, 20, "m/s"},
      {.help = "fastest relative speed expected; enters the time step (10 % of the Hertz time) and is watched", .fallback = default_max_speed_m_s});
}

dem::Case make_slice_case(const LineBasics& basics, std::string_view name, const SliceNumerics& numerics, const std::vector<int>& powders,
                          double y_low_m, double y_high_m, double z_low_m, double z_high_m) {
  dem::Case c;
  c.name = std::string(name);
  c.box.low = Vec3(0, y_low_m, z_low_m);
  c.box.high = Vec3(numerics.slice_width_m, y_high_m, z_high_m);
  c.box.periodic[0] = true;
  c.gravity_m_s2 = Vec3(0, 0, -kStandardGravity_m_s2);
  c.materials = basics.materials;
  for (const int p : powders) {
    const PowderSpec& spec = basics.powders[static_cast<std::size_t>(p)];
    c.powders.push_back({spec.name, spec.psd, LineBasics::kGrain});
  }
  c.coarse_graining = numerics.coarse_graining;
  c.expected_max_speed_m_s = numerics.expected_max_speed_m_s;
  // Every case draws from its own stream: the case's name is folded into the seed.
  c.seed = basics.seed ^ stream_id(name);
  return c;
}

std::size_t add_profile_wall(dem::Case& c, std::string name, const Profile& yz_m, int material, const dem::WallMotion& motion,
                             const dem::Interval& present) {
  dem::Wall wall;
  wall.name = std::move(name);
  wall.shape = dem::extrude_profile(yz_m, c.box.low.x(), c.box.high.x());
  wall.motion = motion;
  wall.material = material;
  wall.present = present;
  c.walls.push_back(std::move(wall));
  return c.walls.size() - 1;
}

dem::CaseResult run_slice(const dem::Case& c, const std::filesystem::path& checkpoint, Context& context) {
  dem::RunOptions options;
  options.checkpoint = checkpoint;
  // Kept until the operator is in the store (the chain then removes the folder): an interruption after the DEM does not repeat it.
  options.keep_checkpoint = true;
  if (!std::filesystem::exists(checkpoint)) return run_case(c, options, context);
  try {
    return run_case(c, options, context);
  } catch (const UsageError& e) {
    // A state that another version of the program left under the same key.
    context.log.warn(std::string(e.what()) + ": started anew");
    std::filesystem::remove(checkpoint);
    return run_case(c, options, context);
  }
}

dem::CaseCost estimate_slice_cost(const dem::Case& c, int threads) {
  dem::Case resident = c;
  resident.rains.clear();
  dem::CaseCost cost = dem::estimate_cost(resident, threads);
  // Lattice fills are looser (about 0.37 solid) than the settled powder the feed tops them up to (about 0.58).
  const double denser = c.rains.empty() ? 1.0 : 1.55;
  cost.particles *= denser, cost.particle_steps *= denser, cost.memory_bytes *= denser, cost.seconds *= denser;
  return cost;
}

double largest_grain_m(const LineBasics& basics, double coarse_graining) {
  double d = 0;
  for (const PowderSpec& p : basics.powders) d = std::max(d, p.psd.upper_cut_m * coarse_graining);
  return d;
}

double smallest_grain_m(const LineBasics& basics, double coarse_graining) {
  double d = HUGE_VAL;
  for (const PowderSpec& p : basics.powders) d = std::min(d, p.psd.lower_cut_m * coarse_graining);
  return d;
}

double mean_grain_m(const LineBasics& basics, int powder, double coarse_graining) {
  const PowderSpec& spec = basics.powders[static_cast<std::size_t>(powder)];
  const double mass = dem::mean_grain_mass(spec.psd, spec.granule_density_kg_m3, coarse_graining);
  return std::cbrt(6.0 * mass / (M_PI * spec.granule_density_kg_m3));
}

void warn_if_too_coarse(const LineBasics& basics, int powder, const SliceNumerics& numerics, std::string_view what, double opening_m,
                        std::vector<std::string>& warnings) {
  const double grain = dem::mean_volume_grain_m(basics.powders[static_cast<std::size_t>(powder)].psd, 1);
  std::string text = dem::opening_warning(what, opening_m, true, grain, numerics.coarse_graining);
  if (!text.empty()) warnings.push_back(std::move(text));
}
}  // namespace venato::line
