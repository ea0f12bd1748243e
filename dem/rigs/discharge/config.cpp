#include <algorithm>

#include "dem/case_reader_parts.h"
#include "dem/rigs/discharge/rig.h"

namespace venato::dem::rigs::discharge {
namespace {
constexpr double kBeforeOpening_s = 1e-3;

void read_windows(ObjectReader& r, const Case& c, Config& config) {
  r.objects("openings", "openings, one after the other; the walls of the case make them (present from … to)", 1, 20,
            [&](ObjectReader& o, std::size_t) {
              Window w;
              o.number("size_mm", w.size_m, {1e-3, 1e4, "mm"}, {.help = "diameter of the hole or width of the slot"});
              o.number("from_s", w.from_s, {0, 1e4, "s"}, {.help = "opens"});
              o.number("to_s", w.to_s, {0, 1e4, "s"}, {.help = "closes, or the next opening takes its place"});
              if (!(w.to_s > w.from_s + config.settle_s)) o.issue("to_s", "it closes before the flow has settled", "from_s + settle_s < to_s");
              if (c.duration_s > 0 && w.to_s > c.duration_s)
                o.issue("to_s", "it closes after the end of the run", "duration_s is the simulated time");
              if (!config.openings.empty() && w.from_s < config.openings.back().to_s)
                o.issue("from_s", "it opens before the one before it has closed", "one opening at a time, in order");
              config.openings.push_back(w);
            });
}
}  // namespace

void read(ObjectReader& r, Case& c, Config& config) {
  r.pick("opening", "form of the openings",
         {{"hole", "round", [&](ObjectReader&) { config.slot = false; }},
          {"slot", "long", [&](ObjectReader& o) {
             config.slot = true;
             o.number("slot_length_mm", config.slot_length_m, {1e-3, 1e5, "mm"}, {.help = "length of the slot inside the box"});
             o.boolean("slot_periodic", config.slot_periodic, {.help = "it goes on through a periodic face of the box", .fallback = true});
           }}});
  r.name("counter", config.counter, {.help = "counter below the opening"});
  if (!r.describing() && !config.counter.empty() &&
      std::none_of(c.counters.begin(), c.counters.end(), [&](const Counter& k) { return k.name == config.counter; }))
    r.issue("counter", "there is no counter '" + config.counter + "'", "add it to counters, below the opening");
  r.number("settle_s", config.settle_s, {0, 100, "s"}, {.help = "after opening, before the flow counts", .fallback = 0.05});
  read_windows(r, c, config);
  r.optional_object("bulk_region", "where the bulk density of Beverloo's law is taken, just before the first opening", [&](ObjectReader& o) {
    config.has_bulk = true;
    read_region(o, c, config.bulk_low, config.bulk_high, "the region");
  });
  if (config.has_bulk && !config.openings.empty() && !r.describing()) {
    const double at = std::max(0.0, config.openings.front().from_s - kBeforeOpening_s);
    config.bulk_plan = c.snapshots.size();
    c.snapshots.push_back({at, at + 0.5 * kBeforeOpening_s, kBeforeOpening_s});  // one frame
  }
  for (const Window& w : config.openings) c.openings.push_back({config.slot ? "slot" : "hole", w.size_m, config.slot});
}

RigDescriptor descriptor() {
  return {"discharge", "discharge flow through holes or slots, with Beverloo's law through several", [](ObjectReader& r, Case& c) {
            Config config;
            read(r, c, config);
            return Rig{"discharge", [config](const Case& of, const CaseResult& result) { return measure(config, of, result); }};
          }};
}
}  // namespace venato::dem::rigs::discharge
