#include "dem/rigs/static_repose/rig.h"
namespace venato::dem::rigs::static_repose {

void read(ObjectReader& r, Config& c) {
  r.number("floor_z_mm", c.floor_z_m, {-1e5, 1e5, "mm"}, {.help = "height of the plate that the heap stands on", .fallback = 0.0});
  r.integer("wedges", c.wedges, {3, 36, ""}, {.help = "the heap is cut into so many wedges; error bars come from their differences", .fallback = 6});
  r.number("fit_from", c.fit_from, {0, 0.9, ""}, {.help = "foot of the fitted flank, share of the apex height", .fallback = 0.15});
  r.number("fit_to", c.fit_to, {0.1, 1, ""}, {.help = "top of the fitted flank, share of the apex height", .fallback = 0.80});
  r.number("ring_width_mm", c.ring_width_m, {0, 1e4, "mm"}, {.help = "rings of the profile; 0 = one mean grain", .fallback = 0.0});
  if (!(c.fit_to > c.fit_from)) r.issue("fit_to", "is not above fit_from", "e.g. 0.15 and 0.80");
}

RigDescriptor descriptor() {
  return {"static_repose", "static angle of repose: flank of the heap that is left at the end", [](ObjectReader& r, Case&) {
            Config config;
            read(r, config);
            return Rig{"static_repose", [config](const Case& c, const CaseResult& result) { return measure(config, c, result); }};
          }};
}
}  // namespace venato::dem::rigs::static_repose
