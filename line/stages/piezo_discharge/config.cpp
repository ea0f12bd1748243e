#include "line/stages/piezo_discharge/config.h"

#include <cmath>

namespace venato::line::piezo_discharge {

void read(ObjectReader& r, Config& c) {
  r.number("prong_pitch_mm", c.prong_pitch_m, {1, 20, "mm"},
           {.help = "distance of neighbouring prongs across the belt", .fallback = 5.0, .placeholder = true});
  r.number("tick_ms", c.tick_s, {1, 100, "ms"}, {.help = "shortest command step", .fallback = 20.0, .placeholder = true});
  r.number("min_on_ms", c.min_on_s, {0, 2000, "ms"}, {.help = "shortest on (and off) time a prong is given", .fallback = 60.0, .placeholder = true});
  r.integer("rows_in_series", c.rows_in_series, {1, 32},
            {.help = "rows of prongs along the belt that share one command", .fallback = 4, .placeholder = true});
  r.number("nominal_delay_ms", c.nominal_delay_s, {0, 5000, "ms"},
           {.help = "delay from command to belt that the line's controller already takes off", .fallback = 100.0, .placeholder = true});
  r.object(
      "drive", "piezo drive of a prong",
      [&](ObjectReader& d) {
        d.number("frequency_hz", c.frequency_hz, {20, 2000, "Hz"}, {.help = "vibration frequency", .fallback = 300.0, .placeholder = true});
        d.number("amplitude_um", c.amplitude_m, {1, 1000, "um"},
                 {.help = "vibration amplitude at full drive (zero to peak)", .fallback = 100.0, .placeholder = true});
        d.number("angle_deg", c.angle_rad, {0, 80, "deg"},
                 {.help = "direction of vibration above the belt direction", .fallback = 30.0, .placeholder = true});
        d.numbers("levels", c.drive_levels, {0.05, 1.0, "", "fraction of the amplitude"}, 0, 8,
                  {.help = "further drive levels at which the steady mass flow is measured", .fallback = std::vector<double>{0.5, 0.75}});
      },
      false);
  r.object(
      "geometry", "section of hopper and prong",
      [&](ObjectReader& g) {
        g.number("outlet_mm", c.outlet_m, {2, 60, "mm"},
                 {.help = "length of the hopper outlet along the belt", .fallback = 10.0, .placeholder = true});
        g.number("gap_mm", c.gap_m, {1, 40, "mm"}, {.help = "opening between front wall and prong", .fallback = 8.0, .placeholder = true});
        g.number("plate_mm", c.plate_m, {1, 100, "mm"},
                 {.help = "prong length beyond the front wall; long enough that the resting heap seals", .fallback = 17.0, .placeholder = true});
        g.number("hopper_height_mm", c.hopper_height_m, {5, 200, "mm"},
                 {.help = "powder level in the hopper, held constant", .fallback = 30.0, .placeholder = true});
        g.number("fall_mm", c.fall_m, {1, 200, "mm"}, {.help = "fall from the prong to the belt", .fallback = 30.0, .placeholder = true});
      },
      false);
  r.object(
      "dem", "numerics of the DEM slice",
      [&](ObjectReader& d) {
        read_slice_numerics(d, c.numerics, 4, 5, 1.5);
        d.integer("pulses", c.pulses, {4, 200}, {.help = "pulses of the pseudo-random train the response is identified from", .fallback = 14});
        d.number("min_on_ms", c.min_on_pulse_s, {5, 1000, "ms"}, {.help = "shortest pulse and pause of the train", .fallback = 40.0});
        d.number("max_on_ms", c.max_on_pulse_s, {5, 2000, "ms"}, {.help = "longest pulse and pause of the train", .fallback = 120.0});
        d.number("settle_ms", c.settle_s, {20, 5000, "ms"}, {.help = "rest before the first pulse; what flows then is the leak", .fallback = 200.0});
        if (c.max_on_pulse_s < c.min_on_pulse_s) d.issue("max_on_ms", "is below min_on_ms", "give max_on_ms >= min_on_ms");
      },
      false);
  if (!r.describing() && c.gap_m >= c.plate_m * std::tan(0.9))
    r.issue("geometry", "the prong is too short to hold the powder back", "plate_mm of about twice gap_mm seals at a repose angle of 27 degrees");
}
}  // namespace venato::line::piezo_discharge
