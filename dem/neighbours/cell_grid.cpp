#include "dem/neighbours/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace venato::dem {
namespace {
constexpr int kMostLevels = 6;  // size ratios up to 64; smaller grains share the last level
constexpr std::int64_t kCellsPerGrain = 8, kFreeCells = 4096;
constexpr double kRodGrains = 256;  // whose cube a rod is as wide as: a block of pair_list.h, so that few pairs cross its border
constexpr std::int64_t kWidestRod = 8;
}  // namespace

void CellGrid::Level::number_cells(std::int64_t width) {
  const std::int64_t nx = axis[0].count, ny = axis[1].count, nz = axis[2].count, rods_y = (ny + width - 1) / width;
  slice = width * width;
  cells = nx * rods_y * ((nz + width - 1) / width) * slice;
  part_y.clear(), part_z.clear(), rod_end_y.clear();
  for (std::int64_t y = 0; y < ny; ++y) {
    part_y.push_back(y / width * nx * slice + y % width);
    rod_end_y.push_back(std::min(ny, (y / width + 1) * width) - 1);
  }
  for (std::int64_t z = 0; z < nz; ++z) part_z.push_back(z / width * rods_y * nx * slice + z % width * width);
}

PeriodicBox PeriodicBox::from(const Box& box) {
  PeriodicBox p;
  for (int a = 0; a < 3; ++a)
    if (box.periodic[a]) {
      p.low[static_cast<std::size_t>(a)] = box.low[a];
      p.length[static_cast<std::size_t>(a)] = box.high[a] - box.low[a];
    }
  return p;
}

std::int64_t CellGrid::Axis::cell_of(double v) const {
  const std::int64_t k = raw(v);
  if (periodic) return std::clamp<std::int64_t>(k, 0, count - 1);  // wrapped already; rounding may touch the upper face
  if (slabs.empty()) return std::clamp<std::int64_t>(k, 0, count - 1);
  return std::lower_bound(slabs.begin(), slabs.end(), k) - slabs.begin();
}

void CellGrid::Axis::range(double low, double high, std::int64_t& first, std::int64_t& last) const {
  first = raw(low), last = raw(high);
  if (periodic) {
    if (last - first + 1 >= count) {
      first = 0, last = count - 1;
    } else if (first >= count || last < 0) {  // asked from just outside the box
      const std::int64_t move = first >= count ? -count : count;
      first += move, last += move;
      if (first >= count || last < 0) first = 0, last = count - 1;  // only a grain that blew up is that far out
    }
  } else if (slabs.empty()) {
    first = std::max<std::int64_t>(first, 0), last = std::min(last, count - 1);
  } else {
    first = std::lower_bound(slabs.begin(), slabs.end(), first) - slabs.begin();
    last = std::upper_bound(slabs.begin(), slabs.end(), last) - slabs.begin() - 1;
  }
}

void CellGrid::shape_level(Level& level, std::span<const Sphere> spheres, std::span<const std::int32_t> members, const PeriodicBox& box,
                           double cell) {
  double low[3], high[3];
  for (int a = 0; a < 3; ++a) low[a] = std::numeric_limits<double>::infinity(), high[a] = -low[a];
  for (const std::int32_t k : members) {
    const Sphere& s = spheres[static_cast<std::size_t>(k)];
    const double p[3] = {s.x, s.y, s.z};
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  }
  const std::int64_t most = kCellsPerGrain * static_cast<std::int64_t>(members.size()) + kFreeCells;
  auto cells = [&] {
    double product = 1;
    for (const Axis& x : level.axis) product *= static_cast<double>(x.count);
    return product;
  };
  for (bool compressed = false;; cell *= compressed ? 2 : 1) {
    for (int a = 0; a < 3; ++a) {
      Axis& x = level.axis[a];
      x.slabs.clear();
      const std::size_t s = static_cast<std::size_t>(a);
      x.periodic = box.length[s] > 0;
      if (x.periodic) {
        x.count = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(box.length[s] / cell)));
        x.origin = box.low[s], x.cell = box.length[s] / static_cast<double>(x.count);
      } else {
        x.origin = low[a], x.cell = cell;
        const double extent = (high[a] - low[a]) / cell;
        x.count = extent < 1e15 ? static_cast<std::int64_t>(extent) + 1 : std::numeric_limits<std::int32_t>::max();
      }
    }
    if (cells() <= static_cast<double>(most)) return;
    for (int a = 0; a < 3; ++a) {
      Axis& x = level.axis[a];
      if (x.periodic) continue;
      for (const std::int32_t k : members) {
        const Sphere& sphere = spheres[static_cast<std::size_t>(k)];
        const double p[3] = {sphere.x, sphere.y, sphere.z};
        x.slabs.push_back(x.raw(p[a]));
      }
      std::sort(x.slabs.begin(), x.slabs.end());
      x.slabs.erase(std::unique(x.slabs.begin(), x.slabs.end()), x.slabs.end());
      x.count = static_cast<std::int64_t>(x.slabs.size());
    }
    if (cells() <= static_cast<double>(most)) return;
    compressed = true;  // still too many (a diagonal line of grains): coarser cells
  }
}

void CellGrid::sort_level(Level& level, std::span<const Sphere> spheres, std::span<const std::int32_t> members, int threads,
                          std::span<std::int32_t> order) {
  const std::int64_t m = static_cast<std::int64_t>(members.size());
  const double box_cells =
      static_cast<double>(level.axis[0].count) * static_cast<double>(level.axis[1].count) * static_cast<double>(level.axis[2].count);
  level.number_cells(std::clamp<std::int64_t>(std::llround(std::cbrt(kRodGrains * box_cells / static_cast<double>(m))), 2, kWidestRod));
  std::vector<std::int32_t> cell(members.size());
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1 && m > 4096)
  for (std::int64_t q = 0; q < m; ++q) {
    const Sphere& s = spheres[static_cast<std::size_t>(members[static_cast<std::size_t>(q)])];
    cell[static_cast<std::size_t>(q)] =
        static_cast<std::int32_t>(level.cell(level.axis[0].cell_of(s.x), level.axis[1].cell_of(s.y), level.axis[2].cell_of(s.z)));
  }
  level.start.assign(static_cast<std::size_t>(level.cells) + 1, 0);
  for (const std::int32_t c : cell) ++level.start[static_cast<std::size_t>(c) + 1];
  for (std::size_t c = 1; c < level.start.size(); ++c) level.start[c] += level.start[c - 1];
  std::vector<std::int32_t> next(level.start.begin(), level.start.end() - 1);
  for (std::size_t q = 0; q < members.size(); ++q) order[static_cast<std::size_t>(next[static_cast<std::size_t>(cell[q])]++)] = members[q];
}

std::vector<std::int32_t> CellGrid::build(std::span<const Sphere> spheres, const PeriodicBox& box, int threads, SlotOrder slots) {
  const std::size_t n = spheres.size();
  std::vector<std::int32_t> order(n);
  clear();
  if (n == 0) return order;
  double r_max = 0;
  for (const Sphere& s : spheres) r_max = std::max(r_max, s.r);
  std::vector<std::vector<std::int32_t>> members(kMostLevels);
  for (std::size_t k = 0; k < n; ++k) {
    int level = 0;
    for (double bound = r_max / 2; level + 1 < kMostLevels && spheres[k].r < bound; bound /= 2) ++level;
    members[static_cast<std::size_t>(level)].push_back(static_cast<std::int32_t>(k));
  }
  std::size_t first = 0, most = 0;
  double usual = 0;  // largest radius of the level with most grains
  for (auto& group : members) {
    if (group.empty()) continue;
    Level& level = levels_.emplace_back();
    for (const std::int32_t k : group) level.r_max = std::max(level.r_max, spheres[static_cast<std::size_t>(k)].r);
    if (group.size() > most) most = group.size(), usual = level.r_max;
    level.first_place = static_cast<std::int32_t>(first);
    shape_level(level, spheres, group, box, 2 * level.r_max);
    sort_level(level, spheres, group, threads, std::span(order).subspan(first, group.size()));
    first += group.size();
    group = std::vector<std::int32_t>();
  }
  if (slots == SlotOrder::by_level || levels_.size() == 1) return order;
  // Blocks of one size only would share nearly every pair of a big and a small grain, and both would compute it.
  std::vector<std::int32_t> all(n), mixed(n), slot_of(n);
  std::iota(all.begin(), all.end(), 0);
  Level together;
  shape_level(together, spheres, all, box, 2 * usual);
  sort_level(together, spheres, all, threads, mixed);
  for (std::size_t k = 0; k < n; ++k) slot_of[static_cast<std::size_t>(mixed[k])] = static_cast<std::int32_t>(k);
  slot_.resize(n);
  for (std::size_t k = 0; k < n; ++k) slot_[k] = slot_of[static_cast<std::size_t>(order[k])];
  return mixed;
}
}  // namespace venato::dem
