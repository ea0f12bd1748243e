#include <algorithm>
#include <cstdio>

#include "dem/picture/picture.h"
#include "dem/run_case_state.h"

namespace venato::dem {
namespace {
std::string text_of(const char* format, double value) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
}  // namespace

void take_picture(CaseRun& run) {
  const PicturePlan& plan = run.c.pictures;
  PictureScene scene;
  scene.low = plan.has_region ? plan.low : run.c.box.low;
  scene.high = plan.has_region ? plan.high : run.c.box.high;
  scene.walls = present_walls(run).triangles;
  const double full = plan.full_speed_m_s > 0 ? plan.full_speed_m_s : run.c.expected_max_speed_m_s;
  double smallest = 0, largest = 0;  // of all powders
  for (const Powder& p : run.c.powders) {
    const double low = 0.5 * p.psd.lower_cut_m * run.c.coarse_graining, high = 0.5 * p.psd.upper_cut_m * run.c.coarse_graining;
    smallest = smallest == 0 ? low : std::min(smallest, low), largest = std::max(largest, high);
  }
  const auto grains = run.sim.grains();
  scene.grains.reserve(grains.size());
  for (const GrainState& g : grains) {
    const Rgb colour = plan.colour == PictureColour::powder ? powder_colour(g.species)
                       : plan.colour == PictureColour::speed
                           ? scale_colour(g.velocity_m_s.norm() / full)
                           : scale_colour(largest > smallest ? (g.radius_m - smallest) / (largest - smallest) : 0.5);
    scene.grains.push_back({in_box(run.c.box, g.position_m), g.radius_m, colour});
  }
  scene.caption = run.c.name + "  t = " + text_of("%.3f s", run.sim.time_s()) + "  " + std::to_string(grains.size()) + " grains";
  if (plan.colour == PictureColour::speed) scene.scale_title = "speed", scene.scale_low = "0", scene.scale_high = text_of("%.3g m/s", full);
  if (plan.colour == PictureColour::size)
    scene.scale_title = "diameter", scene.scale_low = text_of("%.3g", 2e3 * smallest), scene.scale_high = text_of("%.3g mm", 2e3 * largest);
  run.options.on_picture(render(scene, {plan.view, plan.width_px, 2, true}), static_cast<int>(run.pictures), run.sim.time_s());
  ++run.pictures;
}
}  // namespace venato::dem
