#include "line/chain/check_line.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "base/error.h"
#include "base/store/store.h"
#include "line/chain/operators.h"
#include "line/chain/pictures.h"
namespace venato::line {
namespace {
// Beds alive at once while a stage is applied: input, output and one copy inside the convolution.
constexpr double kBedsAtOnce = 4;

graphics::VeinPlan plain_plan(const LineBasics& b) {
  graphics::VeinPlan plan;
  for (const auto& p : b.powders) plan.powders.push_back(p.name);
  plan.body_powder = b.body_powder;
  plan.fraction = graphics::RasterF(1, 1, static_cast<int>(b.powders.size()), std::max(b.fired_length_m, b.fired_width_m));
  plan.fraction.at(0, 0, b.body_powder) = 1;
  return plan;
}

std::string line_of(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string line_of(const char* format, ...) {
  char text[400];
  va_list args;
  va_start(args, format);
  std::vsnprintf(text, sizeof text, format, args);
  va_end(args);
  return std::string(text) + "\n";
}
}  // namespace

void check_line(const LineConfig& c) {
  auto issues = check_pictures(c);
  try {
    (void)c.chain.front().stage.plan_commands(plain_plan(c.basics), c.basics);
  } catch (const UsageError& e) {
    issues.push_back({c.chain.front().pointer, e.what(), ""});
  }
  if (!issues.empty()) throw ConfigError(c.file.string(), issues);
}

LineCost estimate_line_cost(const LineConfig& c, const Store& store, int threads) {
  LineCost out;
  for (const auto& stage : c.chain) {
    StageCost s{stage.stage.name, stage.stage.cost(c.basics, threads), store.find("operator", operator_key(c, stage)).has_value()};
    if (!s.in_store) out.dem_seconds += s.cost.seconds;
    out.stages.push_back(s);
  }
  const auto& g = c.basics.grid;
  out.bed_memory_bytes = kBedsAtOnce * sizeof(double) * static_cast<double>(g.columns()) * g.nz * static_cast<double>(c.basics.powders.size());
  return out;
}

std::string cost_table(const LineConfig& c, const LineCost& cost) {
  const auto& b = c.basics;
  std::string out = line_of("%s is valid; %zu placeholder numbers in use", c.file.string().c_str(), c.placeholders.size());
  out += line_of("slab  %g x %g x %g mm fired, %.1f kg/m2 of moist powder on the belt", b.fired_width_m * 1e3, b.fired_length_m * 1e3,
                 b.fired_thickness_m * 1e3, b.bed_mass_kg_m2);
  out += line_of("bed   %.0f x %.0f mm, %d x %d columns of %g mm, %d layers, about %.0f MiB", b.grid.nx * b.grid.pitch_m * 1e3,
                 b.grid.ny * b.grid.pitch_m * 1e3, b.grid.nx, b.grid.ny, b.grid.pitch_m * 1e3, b.grid.nz, cost.bed_memory_bytes / 1048576.0);
  out += line_of("%-18s %10s %10s %15s %9s %9s  %s", "stage", "particles", "steps", "particle-steps", "memory", "time", "operator");
  for (const auto& s : cost.stages)
    out += line_of("%-18s %10.0f %10.0f %15.2e %5.0f MiB %7.0f s  %s", s.name.c_str(), s.cost.particles, s.cost.steps, s.cost.particle_steps,
                   s.cost.memory_bytes / 1048576.0, s.cost.seconds, s.in_store ? "in the store: no simulation" : "by simulation");
  out += line_of("simulation to do: about %.0f s", cost.dem_seconds);
  return out;
}
}  // namespace venato::line
