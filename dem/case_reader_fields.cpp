#include <cmath>

#include "dem/case_reader_parts.h"

namespace venato::dem {
namespace {
constexpr double kMostCells = 300'000;  // about 0.5 kB each
}

void read_fields(ObjectReader& r, Case& c) {
  r.optional_object("fields", "continuum fields by coarse graining: density, velocity, temperature, stress, wall force", [&c](ObjectReader& o) {
    FieldPlan plan;
    o.number(
        "width_mm", plan.width_m, {1e-4, 1000, "mm"},
        {.help = "standard deviation of the kernel (reach three times that); 0.5 to 1 grain diameter is usual, see the scan in /fields/plateau"});
    read_vec3(o, "grid_mm", plan.cell_m, {1e-4, 1e5, "mm"},
              {.help = "cells along x, y, z, fitted to the box; at least the box length = averaged over that direction"});
    o.number("from_s", plan.from_s, {0, 1e4, "s"}, {.help = "first instant"});
    o.number("to_s", plan.to_s, {0, 1e4, "s"}, {.help = "end of the window"});
    o.number("every_s", plan.every_s, {1e-6, 1000, "s"}, {.help = "interval of the instants that are averaged"});
    o.boolean("diffusivity", plan.diffusivity,
              {.help = "also the diffusivity on a (y, z) grid; keeps all positions of the window", .fallback = false});
    if (!(plan.to_s > plan.from_s)) o.issue("to_s", "the window ends before it starts", "from_s < to_s");
    if (c.duration_s > 0 && plan.from_s >= c.duration_s)
      o.issue("from_s", "the window starts after the end of the run", "duration_s is the simulated time");
    const Vec3 size = c.box.high - c.box.low;
    double cells = 1;
    for (int a = 0; a < 3; ++a)
      if (size[a] > 0 && plan.cell_m[a] > 0) cells *= std::max(1.0, (size[a] + 6 * plan.width_m) / plan.cell_m[a]);
    if (cells > kMostCells)
      o.issue("grid_mm", "the grid would have about " + std::to_string(static_cast<long long>(cells)) + " cells, more than 300000",
              "larger cells, or a direction averaged over");
    c.fields = plan;
  });
}
}  // namespace venato::dem
