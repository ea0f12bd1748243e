#include "dem/rigs/tapped_density/rig.h"
namespace venato::dem::rigs::tapped_density {
namespace {
constexpr double kBeforeTap = 0.01;  // of a period: how long before the next lift a frame is taken
}

void read(ObjectReader& r, Case& c, Config& config) {
  std::vector<double> centre;
  r.numbers("centre_mm", centre, {-1e5, 1e5, "mm"}, 2, 2, {.help = "[x, y] of the cylinder's axis", .fallback = std::vector<double>{0, 0}});
  if (centre.size() == 2) config.centre_x_m = centre[0], config.centre_y_m = centre[1];
  r.number("radius_mm", config.radius_m, {1e-2, 1e4, "mm"}, {.help = "inner radius of the cylinder"});
  r.number("floor_z_mm", config.floor_z_m, {-1e5, 1e5, "mm"}, {.help = "height of its floor at rest", .fallback = 0.0});
  r.number("first_tap_s", config.first_tap_s, {0, 1e4, "s"}, {.help = "start of the first lift: motion/tapping/from_s of the walls"});
  r.number("period_s", config.period_s, {1e-3, 1e4, "s"}, {.help = "time from tap to tap: as in motion/tapping"});
  r.integer("taps", config.taps, {3, 2000, ""}, {.help = "number of taps: as in motion/tapping"});
  if (r.describing() || !(config.period_s > 0)) return;
  const double last = config.first_tap_s + config.taps * config.period_s;
  if (c.duration_s > 0 && last > c.duration_s * (1 + 1e-12))
    r.issue("taps", "the last tap ends after the end of the run", "duration_s >= first_tap_s + taps * period_s");
  if (config.first_tap_s <= kBeforeTap * config.period_s) r.issue("first_tap_s", "there is no time to pour and settle", "e.g. 0.3");
  config.plan = c.snapshots.size();
  const double from = config.first_tap_s - kBeforeTap * config.period_s;
  c.snapshots.push_back({from, from + (config.taps + 0.5) * config.period_s, config.period_s});
}

RigDescriptor descriptor() {
  return {"tapped_density", "tapped density: the whole tapping curve and the Hausner ratio", [](ObjectReader& r, Case& c) {
            Config config;
            read(r, c, config);
            return Rig{"tapped_density", [config](const Case& of, const CaseResult& result) { return measure(config, of, result); }};
          }};
}
}  // namespace venato::dem::rigs::tapped_density
