#include "tests/bench/settled_tile.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"
#include "dem/packing/pack_dense.h"

namespace venato::bench {
namespace {
constexpr double kDepth_m = 12e-3, kSettledFraction = 0.60;  // make the tile's width
constexpr double kRest_m_s = 1e-3;                           // rms speed: 0.2 % of the sheared bed's floor
constexpr double kPackedFraction = 0.58;                     // below what settles, so that the bed makes its own contacts while it sinks
constexpr std::int64_t kBlock = 500, kMostBlocks = 80;
constexpr std::uint64_t kSeed = 1234;

/// Random packing between the floor and a lid that is taken away again.
std::vector<Vec3> packed_start(const std::vector<double>& diameter, double width, double volume, int threads) {
  dem::Box box;
  box.high = Vec3(width, width, volume / (width * width * kPackedFraction));
  box.periodic[0] = box.periodic[1] = true;
  std::vector<double> radii;
  for (const double d : diameter) radii.push_back(0.5 * d);
  dem::PackingOptions options;
  options.seed = kSeed;
  options.threads = threads;
  return dem::pack_dense(box, radii, options).position_m;
}
}  // namespace

StartState settled_tile(const std::string& psd, int threads) {
  const std::vector<double> diameter = dem::sample_diameters(bench_sizes(psd), 1, kTileGrains, kSeed, stream_id("tests/bench/sizes"));
  double volume = 0;
  for (const double d : diameter) volume += std::numbers::pi / 6 * d * d * d;
  StartState tile;
  tile.length_x_m = tile.length_y_m = std::sqrt(volume / kSettledFraction / kDepth_m);

  dem::SimulationSetup setup;
  setup.materials = bench_materials();
  setup.box.high = Vec3(tile.length_x_m, tile.length_y_m, 1);
  setup.box.periodic[0] = setup.box.periodic[1] = true;
  setup.gravity_m_s2 = Vec3(0, 0, -kGravity);
  setup.time_step_s = psd == "mono" ? 2.9e-6 : 1.5e-6;  // 20 % of the smallest grain's Rayleigh time
  setup.threads = threads;
  dem::Simulation sim(setup);
  dem::Wall floor;
  floor.name = "floor";
  floor.shape = dem::PlaneShape{};
  sim.add_wall(floor);
  const std::vector<Vec3> start = packed_start(diameter, tile.length_x_m, volume, threads);
  double mass = 0;
  for (std::size_t k = 0; k < diameter.size(); ++k) {
    dem::GrainInput g;
    g.position_m = start[k];
    g.radius_m = 0.5 * diameter[k];
    mass += sim.grain(sim.insert_free_grain(g)).mass_kg;
  }
  for (std::int64_t block = 0;; ++block) {
    sim.step(kBlock);
    const double speed = std::sqrt(2 * sim.energy().kinetic_j() / mass);
    std::fprintf(stderr, "settling %s: step %lld, rms speed %.3g mm/s, %.2f contacts per grain\n", psd.c_str(),
                 static_cast<long long>(sim.step_number()), speed * 1e3, sim.mean_contacts());
    if (speed < kRest_m_s) break;
    if (block == kMostBlocks) throw WorkError("the tile did not come to rest: rms speed " + std::to_string(speed) + " m/s");
  }
  for (const dem::GrainState& g : sim.grains()) tile.grains.push_back({g.position_m, g.velocity_m_s, g.spin_rad_s, 2 * g.radius_m});
  for (StartGrain& g : tile.grains) {  // back into the periodic box
    g.position_m.x() -= tile.length_x_m * std::floor(g.position_m.x() / tile.length_x_m);
    g.position_m.y() -= tile.length_y_m * std::floor(g.position_m.y() / tile.length_y_m);
  }
  return tile;
}
}  // namespace venato::bench
