#include "dem/rigs/dynamic_repose/rig.h"
namespace venato::dem::rigs::dynamic_repose {

void read(ObjectReader& r, Case& c, Config& config) {
  r.choice("axis", config.axis, {{"x", 0}, {"y", 1}}, {.help = "axis of the drum", .fallback = "x"});
  std::vector<double> centre;
  r.numbers("centre_mm", centre, {-1e5, 1e5, "mm"}, 2, 2, {.help = "[y, z] (axis x) or [x, z] (axis y) of the drum's axis"});
  if (centre.size() == 2) config.centre_m[0] = centre[0], config.centre_m[1] = centre[1];
  r.number("radius_mm", config.radius_m, {1e-2, 1e5, "mm"}, {.help = "inner radius of the drum"});
  r.number("frame_every_s", config.frame_every_s, {1e-5, 100, "s"}, {.help = "interval of the frames that are averaged", .fallback = 0.01});
  r.number("central", config.central, {0.1, 0.9, ""}, {.help = "the slope is fitted over this share of the radius to both sides", .fallback = 0.5});
  r.objects("speeds", "speeds of the drum, one after the other; one wall of the case per speed makes them (present from … to)", 1, 20,
            [&](ObjectReader& o, std::size_t) {
              Plateau p;
              o.number("speed_deg_s", p.speed_rad_s, {1e-3, 1e5, "deg/s"}, {.help = "speed (6 deg/s = 1 rpm)"});
              o.number("from_s", p.from_s, {0, 1e4, "s"}, {.help = "from here on the flow is steady: after starting, at least a quarter turn"});
              o.number("to_s", p.to_s, {0, 1e4, "s"}, {.help = "end of this speed"});
              if (!(p.to_s > p.from_s + 16 * config.frame_every_s)) o.issue("to_s", "the window holds fewer than 16 frames", "two per time block");
              if (c.duration_s > 0 && p.to_s > c.duration_s) o.issue("to_s", "it ends after the end of the run", "duration_s is the simulated time");
              p.plan = c.snapshots.size();
              if (!r.describing() && p.to_s > p.from_s) c.snapshots.push_back({p.from_s, p.to_s, config.frame_every_s});
              config.plateaus.push_back(p);
            });
}

RigDescriptor descriptor() {
  return {"dynamic_repose", "dynamic angle of repose: free surface in a rotating drum, at several speeds", [](ObjectReader& r, Case& c) {
            Config config;
            read(r, c, config);
            return Rig{"dynamic_repose", [config](const Case& of, const CaseResult& result) { return measure(config, of, result); }};
          }};
}
}  // namespace venato::dem::rigs::dynamic_repose
