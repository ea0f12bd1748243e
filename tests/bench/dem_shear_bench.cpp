/// Speed of our engine on one case of tests/bench/cases.txt: warm-up and three windows, one step(n) call each, from the start file that the peers
/// read too.
///   dem_shear_bench CASE [--out DIR] [--threads N] [--start-only]
/// Makes the start files in DIR when they are missing (settled tile, tiled bed) and prints one item per line: `name value ...`.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/hardware.h"
#include "base/io/atomic_file.h"
#include "base/version.h"
#include "tests/bench/settled_tile.h"
#include "tests/bench/shear_case.h"
#include "tests/bench/start_file.h"

namespace venato::bench {
namespace {
namespace fs = std::filesystem;

struct Options {
  std::string name;
  fs::path out = "out/bench";
  int threads = available_cores();
  bool start_only = false;
};

Options read_options(int argc, char** argv) {
  Options o;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const auto value = [&] {
      if (k + 1 == argc) throw UsageError(word + " needs a value");
      return std::string(argv[++k]);
    };
    if (word == "--out")
      o.out = value();
    else if (word == "--threads") {
      const std::string text = value();
      char* end = nullptr;
      const long n = std::strtol(text.c_str(), &end, 10);
      if (*end != '\0' || n < 1 || n > 4096) throw UsageError("--threads " + text + " is not a number of threads");
      o.threads = static_cast<int>(n);
    } else if (word == "--start-only")
      o.start_only = true;
    else if (word.starts_with("-") || !o.name.empty())
      throw UsageError("unexpected argument '" + word + "'; usage: dem_shear_bench CASE [--out DIR] [--threads N] [--start-only]");
    else
      o.name = word;
  }
  if (o.name.empty()) throw UsageError("usage: dem_shear_bench CASE [--out DIR] [--threads N] [--start-only]");
  return o;
}

/// Start file of the case; made from the cached tile when missing. A change of what a tile is needs a new kStartVersion.
constexpr int kStartVersion = 2;
fs::path start_of(const ShearCase& c, const fs::path& out, int threads) {
  const std::string version = "v" + std::to_string(kStartVersion);
  const fs::path start = out / ("start_" + c.name + "_" + version + ".data");
  if (fs::exists(start)) return start;
  make_output_folder(out);
  const double density = bench_materials().materials.front().density_kg_m3;
  const fs::path tile = out / ("tile_" + c.psd + "_" + version + ".data");
  if (!fs::exists(tile)) write_start(tile, settled_tile(c.psd, threads), density);
  write_start(start, tile_and_shear(read_start(tile), c.tiles_x, c.tiles_y, c.floor_m_s), density);
  return start;
}

dem::Simulation make_simulation(const ShearCase& c, const fs::path& file, int threads) {
  const StartState start = read_start(file);
  dem::SimulationSetup setup;
  setup.materials = bench_materials();
  setup.box.high = Vec3(start.length_x_m, start.length_y_m, 1);
  setup.box.periodic[0] = setup.box.periodic[1] = true;
  setup.gravity_m_s2 = Vec3(0, 0, -kGravity);
  setup.time_step_s = c.time_step_s;
  setup.threads = threads;
  dem::Simulation sim(setup);
  dem::Wall floor;
  floor.name = "floor";
  floor.shape = dem::PlaneShape{};
  floor.motion.surface_velocity_m_s = Vec3(c.floor_m_s, 0, 0);
  sim.add_wall(floor);
  for (const StartGrain& g : start.grains) {
    dem::GrainInput in;
    in.position_m = g.position_m;
    in.velocity_m_s = g.velocity_m_s;
    in.spin_rad_s = g.spin_rad_s;
    in.radius_m = 0.5 * g.diameter_m;
    sim.add_grain(in);
  }
  return sim;
}

double timed_steps(dem::Simulation& sim, std::int64_t n) {
  const auto from = std::chrono::steady_clock::now();
  sim.step(n);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
}

void print_window(const char* name, const dem::Simulation& sim, double seconds) {
  const dem::StepStatistics& s = sim.statistics();
  const double rate = static_cast<double>(s.steps) * static_cast<double>(sim.grain_count()) / seconds;
  std::printf("%s steps %lld seconds %.4f particle_steps_per_s %.5g list_builds %lld listed_pairs %.0f\n", name, static_cast<long long>(s.steps),
              seconds, rate, static_cast<long long>(s.list_builds), s.pair_count);
  const double known = s.seconds_list + s.seconds_scan + s.seconds_contact + s.seconds_integrate + s.seconds_walls;
  std::printf("phases_s list %.4f scan %.4f contact %.4f integrate %.4f walls %.4f other %.4f\n", s.seconds_list, s.seconds_scan, s.seconds_contact,
              s.seconds_integrate, s.seconds_walls, seconds - known);
  std::fflush(stdout);
}

/// State at the end, as the peers print it: mean contacts between grains, kinetic energies.
void print_state(const dem::Simulation& sim) {
  double pairs = 0;
  for (const dem::ContactState& c : sim.contacts()) pairs += c.j >= 0 ? 1 : 0;
  const dem::EnergyBook energy = sim.energy();
  std::printf("coordination %.4f with_floor %.4f\n", 2 * pairs / static_cast<double>(sim.grain_count()), sim.mean_contacts());
  std::printf("kinetic_j translation %.6g rotation %.6g\n", energy.kinetic_translation_j, energy.kinetic_rotation_j);
  std::printf("state_hash %016llx\n", static_cast<unsigned long long>(sim.state_hash()));
}

void run(const Options& o) {
  const ShearCase c = find_case(read_cases(fs::path(VENATO_SOURCE_DIR) / "tests/bench/cases.txt"), o.name);
  const fs::path file = start_of(c, o.out, o.threads);
  if (o.start_only) {
    std::printf("start_file %s\n", file.c_str());
    return;
  }
  dem::Simulation sim = make_simulation(c, file, o.threads);
  std::printf("case %s grains %zu threads %d dt_s %g cpu %s\n", c.name.c_str(), sim.grain_count(), o.threads, c.time_step_s,
              cpu_model_name().c_str());
  print_window("warmup", sim, timed_steps(sim, c.warmup_steps));
  for (int k = 0; k < kWindows; ++k) {
    sim.reset_statistics();
    print_window("window", sim, timed_steps(sim, c.window_steps));
  }
  const double peak = static_cast<double>(peak_memory_bytes());  // before contacts() below makes its copies
  std::printf("peak_memory_mib %.1f bytes_per_grain %.0f\n", peak / 1048576, peak / static_cast<double>(sim.grain_count()));
  print_state(sim);
}
}  // namespace
}  // namespace venato::bench

int main(int argc, char** argv) try {
  venato::keep_freed_memory();  // as venato itself
  venato::bench::run(venato::bench::read_options(argc, argv));
  return 0;
} catch (const venato::UsageError& e) {
  std::fprintf(stderr, "dem_shear_bench: %s\n", e.what());
  return 2;
} catch (const std::exception& e) {
  std::fprintf(stderr, "dem_shear_bench: %s\n", e.what());
  return 1;
}
