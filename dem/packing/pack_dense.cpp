#include "dem/packing/pack_dense.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "base/error.h"
#include "base/rng.h"
#include "dem/packing/relax.h"

namespace venato::dem {
namespace {
constexpr double kClosePacked = 0.74048;  // pi / sqrt(18): densest packing of equal spheres
constexpr double kMostDense = 0.95;       // no mix in use comes near; keeps the search for one finite
constexpr double kPeriodicDiameters = 2.1;
constexpr double kNearGap = 0.01;  // of the smaller radius: counts as neighbour
// Spheres repel a little before they touch, so that the hard overlaps vanish in finite time; the swollen fraction must stay below jamming.
constexpr double kSwelling = 2e-3;

std::string text(double value, const char* format = "%.4g") {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

double sphere_volume(std::span<const double> radii) {
  double sum = 0;
  for (const double r : radii) sum += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return sum;
}

void check(const Box& box, std::span<const double> radii, const PackingOptions& o) {
  if (!(o.max_overlap > 0 && o.max_overlap <= 0.2))
    throw UsageError("dense packing: the overlap limit " + text(o.max_overlap) + " is outside (0, 0.2] of the smaller radius");
  if (o.threads < 1) throw UsageError("dense packing: threads = " + std::to_string(o.threads) + " is outside [1, inf)");
  if (radii.size() > 2'000'000'000) throw UsageError("dense packing: more than 2e9 spheres");
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  for (const double r : radii) {
    if (!(r > 0) || !std::isfinite(r)) throw UsageError("dense packing: radius " + text(r) + " m is not > 0");
    largest = std::max(largest, r), smallest = std::min(smallest, r);
  }
  for (int a = 0; a < 3; ++a) {
    const double length = box.high[a] - box.low[a];
    const std::string axis(1, "xyz"[a]);
    if (!(length > 0) || !std::isfinite(length))
      throw UsageError("dense packing: the box has no extent along " + axis + ": " + text(box.low[a]) + " to " + text(box.high[a]) + " m");
    const double least = (box.periodic[a] ? kPeriodicDiameters : 1.0) * 2 * largest;
    if (length < least)
      throw UsageError("dense packing: the box is " + text(length * 1e3) + " mm long along " + axis + (box.periodic[a] ? " (periodic)" : "") +
                       "; its largest sphere needs " + text(least * 1e3) + " mm");
  }
  const double fraction = sphere_volume(radii) / (box.high - box.low).prod();
  const double densest = largest <= 1.0001 * smallest ? kClosePacked : kMostDense;
  if (!radii.empty() && fraction >= densest)
    throw UsageError("dense packing: a solid fraction of " + text(fraction) + " is more than " +
                     (densest == kClosePacked ? "the 0.7405 of the densest crystal of equal spheres" : "any packing of spheres has") +
                     "; use fewer spheres or a larger box");
}

/// One sphere at a random place of a random cell of a grid of nearly cubic cells: as random as needed, but without the voids and clumps of wholly
/// random places, which take long to even out.
std::vector<Vec3> random_start(const Box& box, std::size_t n, const PackingOptions& o) {
  const Vec3 size = box.high - box.low;
  const double edge = std::cbrt(size.prod() / static_cast<double>(std::max<std::size_t>(1, n)));
  std::array<std::uint64_t, 3> cells{};
  for (int a = 0; a < 3; ++a) cells[static_cast<std::size_t>(a)] = static_cast<std::uint64_t>(std::max(1.0, std::floor(size[a] / edge)));
  while (cells[0] * cells[1] * cells[2] < n) {  // refine the direction with the longest cells
    int longest = 0;
    for (int a = 1; a < 3; ++a)
      if (size[a] / static_cast<double>(cells[static_cast<std::size_t>(a)]) >
          size[longest] / static_cast<double>(cells[static_cast<std::size_t>(longest)]))
        longest = a;
    ++cells[static_cast<std::size_t>(longest)];
  }
  // Which sphere gets which cell is random, so that radii given in an order (sorted, by powder) end up mixed.
  std::vector<std::uint64_t> cell(cells[0] * cells[1] * cells[2]);
  std::iota(cell.begin(), cell.end(), std::uint64_t{0});
  Rng shuffle(o.seed, stream_id("dem/packing/cells") ^ o.stream);
  for (std::size_t k = cell.size(); k > 1; --k) std::swap(cell[k - 1], cell[shuffle.below(k)]);
  std::vector<Vec3> at(n);
  for (std::size_t k = 0; k < n; ++k) {
    Rng rng(o.seed, stream_id("dem/packing/start") ^ o.stream, k);
    const std::array<std::uint64_t, 3> c{cell[k] % cells[0], cell[k] / cells[0] % cells[1], cell[k] / (cells[0] * cells[1])};
    for (int a = 0; a < 3; ++a) {
      const std::size_t s = static_cast<std::size_t>(a);
      at[k][a] = box.low[a] + size[a] * (static_cast<double>(c[s]) + rng.uniform()) / static_cast<double>(cells[s]);
    }
  }
  return at;
}
}  // namespace

Coordination coordination_of(std::size_t n, std::span<const std::array<std::int32_t, 2>> pairs) {
  Coordination c;
  if (n == 0) return c;
  std::vector<std::int32_t> neighbours(n, 0);
  std::vector<std::uint8_t> rattles(n, 0);
  std::size_t kept_pairs = pairs.size(), rattlers = 0;
  for (bool again = true; again;) {
    again = false;
    std::fill(neighbours.begin(), neighbours.end(), 0);
    kept_pairs = 0;
    for (const auto& [i, j] : pairs) {
      if (rattles[static_cast<std::size_t>(i)] || rattles[static_cast<std::size_t>(j)]) continue;
      ++neighbours[static_cast<std::size_t>(i)], ++neighbours[static_cast<std::size_t>(j)], ++kept_pairs;
    }
    for (std::size_t k = 0; k < n; ++k)
      if (!rattles[k] && neighbours[k] < 4) rattles[k] = 1, ++rattlers, again = true;
  }
  c.all = 2 * static_cast<double>(pairs.size()) / static_cast<double>(n);
  c.backbone = rattlers < n ? 2 * static_cast<double>(kept_pairs) / static_cast<double>(n - rattlers) : 0;
  c.rattlers = static_cast<double>(rattlers) / static_cast<double>(n);
  return c;
}

Packing pack_dense(const Box& box, std::span<const double> radii, const PackingOptions& o) {
  check(box, radii, o);
  Packing packing;
  if (radii.empty()) return packing;
  packing.solid_fraction = sphere_volume(radii) / (box.high - box.low).prod();
  SoftSpheres spheres(box, random_start(box, radii.size(), o), radii, kSwelling, o.threads);
  RelaxLimits limits;
  limits.max_overlap = o.max_overlap;
  const RelaxReport report = relax(spheres, limits);
  if (!report.reached)
    throw UsageError("dense packing: a solid fraction of " + text(packing.solid_fraction) + " cannot be reached: after " +
                     std::to_string(report.iterations) + " iterations spheres still overlap by " + text(report.max_overlap) + " of a radius (limit " +
                     text(o.max_overlap) + "). Random packings of equal spheres jam at 0.64, and earlier between close walls; ask for less");
  packing.max_overlap = report.max_overlap;
  packing.iterations = report.iterations;
  const Coordination c = coordination_of(radii.size(), spheres.near_pairs(kNearGap));
  packing.coordination = c.all, packing.backbone_coordination = c.backbone, packing.rattlers = c.rattlers;
  packing.position_m = spheres.positions_m();
  return packing;
}
}  // namespace venato::dem
