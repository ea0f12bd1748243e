#include "line/stages/powder_feeder/config.h"

#include <cmath>

namespace venato::line::powder_feeder {

void read(ObjectReader& r, Config& c) {
  r.number("nominal_delay_ms", c.nominal_delay_s, {0, 5000, "ms"},
           {.help = "delay from actuator command to landing that the line's controller already takes off", .fallback = 130.0, .placeholder = true});
  r.number("dosing_pitch_mm", c.dosing_pitch_m, {1, 50, "mm"},
           {.help = "width of one body actuator across the belt", .fallback = 5.0, .placeholder = true});
  r.number("tick_ms", c.tick_s, {1, 200, "ms"}, {.help = "shortest step of the actuator command", .fallback = 20.0, .placeholder = true});
  r.object(
      "geometry", "section of hoppers, actuators and common bin",
      [&](ObjectReader& g) {
        g.number("outlet_mm", c.outlet_m, {3, 60, "mm"}, {.help = "opening of each hopper along the belt", .fallback = 13.0, .placeholder = true});
        g.number("hopper_width_mm", c.hopper_width_m, {4, 200, "mm"},
                 {.help = "clear width of each hopper along the belt, above its converging walls", .fallback = 22.0, .placeholder = true});
        g.number("hopper_angle_deg", c.hopper_angle_rad, {30, 85, "deg"},
                 {.help = "inclination of the converging walls", .fallback = 60.0, .placeholder = true});
        g.number("hopper_height_mm", c.hopper_height_m, {10, 200, "mm"},
                 {.help = "powder level in each hopper, held constant", .fallback = 28.0, .placeholder = true});
        g.number("spacing_mm", c.spacing_m, {8, 200, "mm"},
                 {.help = "distance of neighbouring hoppers along the belt", .fallback = 32.0, .placeholder = true});
        g.number("drop_mm", c.drop_m, {20, 400, "mm"},
                 {.help = "height of the hopper outlets above the powder level of the bin", .fallback = 60.0, .placeholder = true});
        g.number("throat_mm", c.throat_m, {5, 100, "mm"},
                 {.help = "clear width of the common bin along the belt", .fallback = 16.0, .placeholder = true});
        g.number("throat_height_mm", c.throat_height_m, {1, 200, "mm"},
                 {.help = "height of the throat's upright walls above the powder level", .fallback = 8.0, .placeholder = true});
        g.number("funnel_angle_deg", c.funnel_angle_rad, {30, 85, "deg"},
                 {.help = "inclination of the funnel walls", .fallback = 65.0, .placeholder = true});
        g.number("target_mm", c.target_m, {1, 100, "mm"},
                 {.help = "discharge target region: middle of the throat", .fallback = 13.0, .placeholder = true});
      },
      false);
  r.object(
      "actuator", "sliding gate under each hopper",
      [&](ObjectReader& a) {
        a.number("travel_time_ms", c.gate_travel_time_s, {1, 500, "ms"}, {.help = "time to open or close", .fallback = 50.0, .placeholder = true});
        a.number("cycle_s", c.cycle_s, {0.2, 10, "s"}, {.help = "feeding cycle of the characterisation: each powder is fed once", .fallback = 1.0});
        a.number("on_share", c.on_share, {0.1, 0.9, "1"},
                 {.help = "share of each powder's part of the cycle in which its actuator is open", .fallback = 0.6});
      },
      false);
  r.object(
      "dem", "numerics of the DEM slice",
      [&](ObjectReader& d) {
        read_slice_numerics(d, c.numerics, 6, 7, 2.0);
        d.integer("cycles", c.cycles, {1, 50}, {.help = "feeding cycles simulated; more make smaller error bars", .fallback = 2});
        d.number("settle_ms", c.settle_s, {20, 5000, "ms"}, {.help = "rest before the first opening", .fallback = 150.0});
      },
      false);
  if (r.describing()) return;
  if (c.spacing_m < c.outlet_m + 0.012)
    r.issue("geometry", "actuators of neighbouring hoppers touch: spacing_mm must exceed outlet_mm by 12 mm", "raise spacing_mm");
  if (c.hopper_width_m <= c.outlet_m || c.spacing_m < c.hopper_width_m + 0.002)
    r.issue("geometry", "hopper_width_mm must exceed outlet_mm and stay 2 mm below spacing_mm", "adjust hopper_width_mm");
  if (c.gate_travel_time_s > 0.6 * c.on_share * 0.85 * c.cycle_s / 2)
    r.issue("actuator", "travel_time_ms leaves no time fully open within on_share of the cycle", "lower travel_time_ms or raise cycle_s");
  const double rim = c.throat_m / 2 + (c.drop_m - c.throat_height_m - 0.008) / std::tan(c.funnel_angle_rad);
  if (rim < (c.spacing_m + c.outlet_m) / 2)
    r.issue("geometry", "the funnel's rim is narrower than the row of two outlets: powder would fall beside it",
            "lower funnel_angle_deg or spacing_mm, or raise drop_mm");
  if (c.target_m > c.throat_m) r.issue("geometry", "target_mm is wider than throat_mm", "lower target_mm");
  if (c.drop_m < c.throat_height_m + 0.01) r.issue("geometry", "drop_mm must exceed throat_height_mm by 10 mm", "raise drop_mm");
}
}  // namespace venato::line::powder_feeder
