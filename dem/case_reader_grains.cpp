#include <limits>

#include "dem/case_reader_parts.h"

namespace venato::dem {
namespace {
const std::vector<double> kZero{0, 0, 0};
constexpr Range kSpeed{-100, 100, "m/s"};
}  // namespace

void read_fill(ObjectReader& r, const Case& c, Fill& fill) {
  read_region(r, c, fill.low, fill.high, "the fill");
  read_fractions(r, c, fill.powder_mass_fractions);
  bool dense = false;
  r.choice("packing", dense, {{"lattice", false}, {"dense", true}},
           {.help = "lattice: loose rows without contacts; dense: random close packing of solid_fraction", .fallback = "lattice"});
  r.number("mass_g", fill.mass_kg, {0, 1e6, "g"}, {.help = "lattice: 0 = as many grains as it holds", .fallback = 0.0});
  r.number("solid_fraction", fill.solid_fraction, {0, 0.74, "", "no packing of equal grains is denser"},
           {.help = "dense: share of the region that is grains; 0.60 to 0.63 is close packed", .fallback = 0.0});
  if (!r.describing()) {
    if (dense && !(fill.solid_fraction >= 0.1))
      r.issue("solid_fraction", "a dense packing needs one of at least 0.1", "0.60 is a settled bed of nearly equal grains");
    if (!dense && fill.solid_fraction > 0) r.issue("solid_fraction", "has no meaning for a lattice", "use \"packing\": \"dense\" or mass_g");
    if (dense && fill.mass_kg > 0) r.issue("mass_g", "has no meaning for a dense packing", "its mass follows from solid_fraction and the region");
  }
  read_vec3(r, "velocity_m_s", fill.velocity_m_s, kSpeed, {.help = "velocity at the start", .fallback = kZero});
}

void read_rain(ObjectReader& r, const Case& c, Rain& rain) {
  r.name("name", rain.name, {.help = "name of the rain"});
  read_region(r, c, rain.low, rain.high, "the rain");
  read_fractions(r, c, rain.powder_mass_fractions);
  r.number("mass_rate_g_s", rain.mass_rate_kg_s, {1e-6, 1e6, "g/s"}, {.help = "mass rate while on"});
  read_intervals(r, "when_s", rain.when, "when it rains, [on, off] each; empty = always");
  read_vec3(r, "velocity_m_s", rain.velocity_m_s, kSpeed, {.help = "velocity of new grains", .fallback = kZero});
  r.optional_object("level_control", "rain only while the heap below is lower than this", [&rain](ObjectReader& o) {
    o.number("z_mm", rain.level_z_m, {-1e5, 1e5, "mm"}, {.help = "height of the highest grain centre"});
  });
}

void read_counter(ObjectReader& r, const Case& c, Counter& counter) {
  r.name("name", counter.name, {.help = "name of the counter (files are named after it)"});
  r.choice("axis", counter.axis, {{"x", 0}, {"y", 1}, {"z", 2}}, {.help = "direction that the plane is crossed along"});
  r.number("position_mm", counter.position_m, {-1e5, 1e5, "mm"}, {.help = "place of the plane on that axis"});
  r.choice("direction", counter.sign, {{"positive", 1}, {"negative", -1}}, {.help = "crossing towards + or -"});
  r.optional_object("window", "only crossings inside this part of the plane count", [&counter](ObjectReader& o) {
    read_vec3(o, "low_mm", counter.window_low, {-1e5, 1e5, "mm"}, {.help = "lower corner"});
    read_vec3(o, "high_mm", counter.window_high, {-1e5, 1e5, "mm"}, {.help = "upper corner"});
    const double inf = std::numeric_limits<double>::infinity();  // across the plane only: a crossing is on it by definition
    counter.window_low[counter.axis] = -inf;
    counter.window_high[counter.axis] = inf;
    for (int k = 0; k < 3; ++k)
      if (k != counter.axis && !(counter.window_high[k] > counter.window_low[k]))
        o.issue("high_mm", "the window is empty", "low < high across the plane");
  });
  r.boolean("remove", counter.remove, {.help = "grains that cross leave the run", .fallback = false});
  r.boolean("first_only", counter.first_only, {.help = "count a grain once", .fallback = true});
  const double low = c.box.low[counter.axis], high = c.box.high[counter.axis];
  if (high > low && (counter.position_m < low || counter.position_m > high))
    r.issue("position_mm", "the plane at " + mm_text(counter.position_m) + " is outside the box, " + mm_text(low) + " to " + mm_text(high),
            "no grain would cross it");
}

void read_snapshots(ObjectReader& r, const Case& c, SnapshotPlan& plan) {
  r.number("from_s", plan.from_s, {0, 1e4, "s"}, {.help = "first frame"});
  r.number("to_s", plan.to_s, {0, 1e4, "s"}, {.help = "end of the window"});
  r.number("every_s", plan.every_s, {1e-6, 1000, "s"}, {.help = "interval of the frames"});
  if (!(plan.to_s > plan.from_s)) r.issue("to_s", "the window ends before it starts", "from_s < to_s");
  if (c.duration_s > 0 && plan.from_s >= c.duration_s)
    r.issue("from_s", "the window starts after the end of the run", "duration_s is the simulated time");
}
}  // namespace venato::dem
