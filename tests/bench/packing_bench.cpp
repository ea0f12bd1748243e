/// Time of a ready dense packing (dem/packing): N spheres in a box periodic in x and y between floor and lid, and what it is worth: largest overlap,
/// coordination, checked here by a search of its own.
///   packing_bench [N] [mono|poly] [--threads N]
/// Prints one item per line: `name value`.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/hardware.h"
#include "base/rng.h"
#include "dem/neighbours/cell_grid.h"
#include "dem/packing/pack_dense.h"
#include "tests/bench/shear_case.h"

namespace venato::bench {
namespace {
constexpr double kFraction = 0.60, kDepth_m = 12e-3;  // the depth of the other cases

long whole_number(const std::string& text) {
  char* end = nullptr;
  const long n = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || n < 1) throw UsageError("'" + text + "' is not a number; usage: packing_bench [N] [mono|poly] [--threads N]");
  return n;
}

/// Largest overlap, of the smaller radius: all pairs that a cell grid of the present places finds, and floor and lid. Negative: a gap everywhere.
double largest_overlap(const dem::Box& box, const std::vector<Vec3>& position, const std::vector<double>& radius) {
  std::vector<dem::Sphere> spheres;
  for (std::size_t k = 0; k < position.size(); ++k) spheres.push_back({position[k].x(), position[k].y(), position[k].z(), radius[k]});
  dem::CellGrid grid;
  const dem::PeriodicBox periodic = dem::PeriodicBox::from(box);
  const std::vector<std::int32_t> order = grid.build(spheres, periodic, 1);
  const auto nearest = [&](double d, std::size_t axis) {
    return periodic.length[axis] > 0 ? d - periodic.length[axis] * std::round(d / periodic.length[axis]) : d;
  };
  double worst = -1;  // no pair that the grid finds is farther apart than this
  for (const dem::Sphere& a : spheres) {
    worst = std::max({worst, (box.low.z() + a.r - a.z) / a.r, (a.z + a.r - box.high.z()) / a.r});
    grid.for_runs_near(a.x, a.y, a.z, a.r, [&](std::int32_t first, std::int32_t last) {
      for (std::int32_t s = first; s < last; ++s) {
        const dem::Sphere& b = spheres[static_cast<std::size_t>(order[static_cast<std::size_t>(s)])];
        if (&a == &b) continue;
        const double d = std::hypot(nearest(a.x - b.x, 0), nearest(a.y - b.y, 1), a.z - b.z);
        worst = std::max(worst, (a.r + b.r - d) / std::min(a.r, b.r));
      }
    });
  }
  return worst;
}

void run(int argc, char** argv) {
  long count = 1'000'000;
  std::string psd = "mono";
  dem::PackingOptions options;
  options.threads = available_cores();
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--threads" && k + 1 < argc)
      options.threads = static_cast<int>(whole_number(argv[++k]));
    else if (word == "mono" || word == "poly")
      psd = word;
    else
      count = whole_number(word);
  }
  std::vector<double> radius = dem::sample_diameters(bench_sizes(psd), 1, static_cast<std::size_t>(count), 1, stream_id("tests/bench/packing"));
  double volume = 0;
  for (double& r : radius) r *= 0.5, volume += 4 * std::numbers::pi / 3 * r * r * r;
  dem::Box box;
  const double width = std::sqrt(volume / kFraction / kDepth_m);
  box.high = Vec3(width, width, kDepth_m);
  box.periodic[0] = box.periodic[1] = true;
  const auto begin = std::chrono::steady_clock::now();
  const dem::Packing p = dem::pack_dense(box, radius, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("spheres %ld\nthreads %d\nseconds %.1f\nsolid_fraction %.4f\niterations %lld\n", count, options.threads, seconds, p.solid_fraction,
              static_cast<long long>(p.iterations));
  std::printf("max_overlap %.3g\nmax_overlap_checked %.3g\n", p.max_overlap, largest_overlap(box, p.position_m, radius));
  std::printf("coordination %.3f\nbackbone_coordination %.3f\nrattlers %.4f\n", p.coordination, p.backbone_coordination, p.rattlers);
  std::printf("bytes_per_sphere %.0f\n", static_cast<double>(peak_memory_bytes()) / static_cast<double>(count));
}
}  // namespace
}  // namespace venato::bench

int main(int argc, char** argv) {
  try {
    venato::bench::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "packing_bench: %s\n", e.what());
    return 2;
  }
}
