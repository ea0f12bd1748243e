#include "line/stages/belt_transport/config.h"

namespace venato::line::belt_transport {

void read(ObjectReader& r, Config& c) {
  r.number(
      "nominal_delay_ms", c.nominal_delay_s, {0, 60000, "ms"},
      {.help = "delay from landing in the bin to the outlet that the line's controller already takes off", .fallback = 500.0, .placeholder = true});
  r.object(
      "geometry", "section of bin, gate and belts",
      [&](ObjectReader& g) {
        g.number("bin_mm", c.bin_m, {10, 200, "mm"}, {.help = "clear width of the common bin along the belt", .fallback = 16.0, .placeholder = true});
        g.number("gate_mm", c.gate_m, {5, 100, "mm"}, {.help = "height of the levelling gate above the belt", .fallback = 28.0, .placeholder = true});
        g.number("level_mm", c.level_m, {10, 300, "mm"},
                 {.help = "powder level in the bin above the belt, held constant", .fallback = 40.0, .placeholder = true});
        g.number("run_mm", c.run_m, {5, 500, "mm"}, {.help = "bed on the first belt after the gate", .fallback = 25.0, .placeholder = true});
        g.number("drop_mm", c.drop_m, {0, 200, "mm"}, {.help = "drop to the next belt", .fallback = 10.0, .placeholder = true});
        g.number("next_run_mm", c.next_run_m, {10, 500, "mm"},
                 {.help = "bed on the next belt up to the outlet", .fallback = 50.0, .placeholder = true});
      },
      false);
  r.object(
      "dem", "numerics of the DEM slice",
      [&](ObjectReader& d) {
        read_slice_numerics(d, c.numerics, 6, 7, 1.5);
        d.number("settle_s", c.settle_s, {0.05, 60, "s"}, {.help = "time until the flow is stationary", .fallback = 0.8});
        d.number("window_s", c.window_s, {0.05, 60, "s"}, {.help = "stationary window the fields are taken from", .fallback = 0.6});
        d.number("frame_ms", c.frame_s, {1, 100, "ms"}, {.help = "distance of the frames in the window", .fallback = 10.0});
        d.integer("tracers", c.tracers, {100, 10000000}, {.help = "tracers projected through the stationary fields", .fallback = 20000});
        if (c.window_s < 10 * c.frame_s) d.issue("window_s", "holds fewer than 10 frames", "lower frame_ms or raise window_s");
      },
      false);
  if (r.describing()) return;
  if (c.level_m <= c.gate_m) r.issue("geometry", "level_mm must exceed gate_mm: the gate would not be covered", "raise level_mm");
}
}  // namespace venato::line::belt_transport
