#include <algorithm>

#include "dem/rigs/inclined_wall/rig.h"
namespace venato::dem::rigs::inclined_wall {

void read(ObjectReader& r, Case& c, Config& config) {
  std::string wall;
  r.name("wall", wall, {.help = "the plate: a plane of the case that rotates slowly"});
  r.number("from_s", config.from_s, {0, 1e4, "s"}, {.help = "the powder rests on the plate; motion counts from here"});
  r.number("to_s", config.to_s, {0, 1e4, "s"}, {.help = "end of tilting"});
  r.number("frame_every_s", config.frame_every_s, {1e-5, 100, "s"}, {.help = "interval at which the powder is looked at", .fallback = 0.01});
  r.number("moved_mm", config.moved_m, {0, 1e4, "mm"},
           {.help = "a grain is off when it has moved so far along the plate; 0 = one mean grain", .fallback = 0.0});
  if (r.describing()) return;
  const auto at = std::find_if(c.walls.begin(), c.walls.end(), [&](const Wall& w) { return w.name == wall; });
  config.wall = static_cast<std::size_t>(at - c.walls.begin());
  if (at == c.walls.end())
    r.issue("wall", "there is no wall '" + wall + "'", "name the plate");
  else if (!std::holds_alternative<PlaneShape>(at->shape) || !(at->motion.rotation_rad_s.norm() > 0))
    r.issue("wall", "wall '" + wall + "' is not a plane that rotates", "give it motion/rotation");
  if (!(config.to_s > config.from_s + 4 * config.frame_every_s)) r.issue("to_s", "the window holds fewer than 4 frames", "tilt for longer");
  if (c.duration_s > 0 && config.to_s > c.duration_s) r.issue("to_s", "it ends after the end of the run", "duration_s is the simulated time");
  config.plan = c.snapshots.size();
  if (config.to_s > config.from_s) c.snapshots.push_back({config.from_s, config.to_s, config.frame_every_s});
}

RigDescriptor descriptor() {
  return {"inclined_wall", "inclined wall: tilt at which powder slides or rolls off a plate", [](ObjectReader& r, Case& c) {
            Config config;
            read(r, c, config);
            return Rig{"inclined_wall", [config](const Case& of, const CaseResult& result) { return measure(config, of, result); }};
          }};
}
}  // namespace venato::dem::rigs::inclined_wall
