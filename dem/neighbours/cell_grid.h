#pragma once
/// Cell grid over spheres, one level per factor of two in radius, so that small grains never search through cells made for big ones.
/// A level has its grains in the order (rod, cell): a rod is a square of cells in y and z that runs along x, slice by slice, as wide as makes any
/// kGrainsPerBlock consecutive grains about a cube: neighbours in space are neighbours in memory, and few pairs cross the border of a block. Cost does
/// not depend on empty space: the grid spans the occupied extent, and where that is mostly empty its axes are compressed to the occupied slabs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "dem/case.h"

namespace venato::dem {

/// Position and radius of a grain: what the search and the first test of every pair read.
struct alignas(32) Sphere {
  double x, y, z, r;
};

/// Box as the search needs it. Non-periodic directions have length 0.
struct PeriodicBox {
  std::array<double, 3> low{}, length{};
  static PeriodicBox from(const Box& box);
  bool periodic(int axis) const { return length[static_cast<std::size_t>(axis)] > 0; }
};

/// Order of the slots. By level: a run of places is a run of slots, for those who search often. Mixed: big and small grains that are neighbours in
/// space are neighbours in memory, for those who compute on blocks of slots.
enum class SlotOrder { by_level, mixed };

class CellGrid {
 public:
  /// \param spheres wrapped into the box in periodic directions; r is the reach of the search, not always the grain's radius
  /// \return order: new slot k holds old slot order[k]
  std::vector<std::int32_t> build(std::span<const Sphere> spheres, const PeriodicBox& box, int threads, SlotOrder slots = SlotOrder::by_level);

  /// Slot at a place of the search, by level and cell.
  std::int32_t slot(std::int32_t place) const { return slot_.empty() ? place : slot_[static_cast<std::size_t>(place)]; }
  /// [place] slots; empty where every place is its own slot.
  std::span<const std::int32_t> slots() const { return slot_; }

  /// Calls visit(first, last) for runs of places that hold every sphere j with |x_j - p| < reach_extra + r_j (and more, once each).
  template <class Visit>
  void for_runs_near(double x, double y, double z, double reach_extra, const Visit& visit) const;

  double largest_radius() const { return levels_.empty() ? 0 : levels_.front().r_max; }
  void clear() { levels_.clear(), slot_.clear(); }

 private:
  struct Axis {
    double origin = 0, cell = 1;
    std::int64_t count = 0;
    bool periodic = false;
    std::vector<std::int64_t> slabs;  ///< occupied slabs, ascending, when compressed
    /// A grain that blew up (not a number, or far out of any box) counts as being in slab 0 until run_case() reports it.
    std::int64_t raw(double v) const {
      const double slab = std::floor((v - origin) / cell);
      return slab > -1e15 && slab < 1e15 ? static_cast<std::int64_t>(slab) : 0;
    }
    std::int64_t cell_of(double v) const;
    void range(double low, double high, std::int64_t& first, std::int64_t& last) const;
  };
  struct Level {
    double r_max = 0;
    Axis axis[3];
    /// Cell (x, y, z) has the number slice * x + part_y[y] + part_z[z]; y and its followers up to rod_end_y[y] are consecutive.
    std::int64_t slice = 1, cells = 0;
    std::vector<std::int64_t> part_y, part_z, rod_end_y;
    /// \param width of a rod, cells
    void number_cells(std::int64_t width);
    std::size_t cell(std::int64_t x, std::int64_t y, std::int64_t z) const {
      return static_cast<std::size_t>(slice * x + part_y[static_cast<std::size_t>(y)] + part_z[static_cast<std::size_t>(z)]);
    }
    std::int32_t first_place = 0;
    std::vector<std::int32_t> start;  ///< [cell + 1], relative to first_place
  };
  static void shape_level(Level& level, std::span<const Sphere> spheres, std::span<const std::int32_t> members, const PeriodicBox& box, double cell);
  /// Counting sort of the members into the level's cells; ties keep their order. \param order room for them all
  static void sort_level(Level& level, std::span<const Sphere> spheres, std::span<const std::int32_t> members, int threads,
                         std::span<std::int32_t> order);
  std::vector<Level> levels_;
  std::vector<std::int32_t> slot_;
};

template <class Visit>
void CellGrid::for_runs_near(double x, double y, double z, double reach_extra, const Visit& visit) const {
  for (const Level& level : levels_) {
    const double reach = reach_extra + level.r_max;
    std::int64_t lo[3], hi[3];
    const double p[3] = {x, y, z};
    bool any = true;
    for (int a = 0; a < 3; ++a) {
      level.axis[a].range(p[a] - reach, p[a] + reach, lo[a], hi[a]);
      any = any && lo[a] <= hi[a];
    }
    if (!any) continue;
    const std::int64_t nx = level.axis[0].count, ny = level.axis[1].count, nz = level.axis[2].count;
    for (std::int64_t kz = lo[2]; kz <= hi[2]; ++kz) {
      const std::int64_t cz = kz < 0 ? kz + nz : (kz >= nz ? kz - nz : kz);
      for (std::int64_t kx = lo[0]; kx <= hi[0]; ++kx) {
        const std::int64_t cx = kx < 0 ? kx + nx : (kx >= nx ? kx - nx : kx);
        auto run = [&](std::int64_t from, std::int64_t to) {
          while (from <= to) {  // rod by rod
            const std::int64_t end = std::min(to, level.rod_end_y[static_cast<std::size_t>(from)]);
            const std::size_t c = level.cell(cx, from, cz);
            const std::int32_t first = level.start[c], last = level.start[c + static_cast<std::size_t>(end - from) + 1];
            if (first < last) visit(level.first_place + first, level.first_place + last);
            from = end + 1;
          }
        };
        if (lo[1] < 0) {
          run(lo[1] + ny, ny - 1);
          run(0, hi[1]);
        } else if (hi[1] >= ny) {
          run(lo[1], ny - 1);
          run(0, hi[1] - ny);
        } else
          run(lo[1], hi[1]);
      }
    }
  }
}
}  // namespace venato::dem
