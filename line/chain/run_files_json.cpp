#include <cmath>
#include <nlohmann/json.hpp>

#include "base/hardware.h"
#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "base/version.h"
#include "line/chain/run_line.h"
#include "sync/command/score_text.h"
namespace venato::line {
namespace {
using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }
Json millimetres(double metres) { return number(metres * 1e3); }

Json gates_json(const std::vector<sync::Gate>& gates) {
  Json out = Json::array();
  for (const auto& g : gates)
    out.push_back({{"name", g.name}, {"value", number(g.value)}, {"limit", number(g.limit)}, {"passed", g.passed}, {"meaning", g.meaning}});
  return out;
}

Json numbers_json(const std::map<std::string, double>& values) {
  Json out = Json::object();
  for (const auto& [name, value] : values) out[name] = number(value);
  return out;
}

Json stages_json(const LineRun& run) {
  Json out = Json::array();
  for (std::size_t s = 0; s < run.chain.stages.size(); ++s) {
    const auto& r = run.chain.stages[s];
    const auto& op = run.operators[s];
    out.push_back({{"name", r.name},
                   {"wall_s", r.wall_s + op.wall_s},
                   {"cached", op.cached},
                   {"mass_in_kg", number(r.mass_in_kg)},
                   {"mass_out_kg", number(r.mass_out_kg)},
                   {"kpi", numbers_json(r.kpi)},
                   {"operator", {{"key", op.key}, {"wall_s", op.wall_s}, {"figures", numbers_json(op.op.figures)}, {"warnings", op.op.warnings}}}});
  }
  return out;
}

Json placeholders_json(const LineConfig& c) {
  Json out = Json::array();
  for (const auto& p : c.placeholders) out.push_back({{"pointer", p.pointer}, {"value", p.value}, {"unit", p.unit}, {"help", p.help}});
  return out;
}

Json figures_json(const LineRun& run) {
  Json out = Json::array();
  for (const auto& f : run.figures) out.push_back({{"file", f.file}, {"section", f.section}, {"title", f.title}, {"caption", f.caption}});
  return out;
}

Json graphic_json(const GraphicUse& g) {
  Json inks = Json::array();
  for (const auto& ink : g.inks) inks.push_back({{"name", ink.name}});
  Json out{{"inks", inks}, {"layers_of_inks", g.layers_of_inks}, {"layers_separated", g.layers_separated}, {"profile", nullptr}};
  if (g.profile)
    out["profile"] = {{"description", g.profile->description}, {"intent", g.intent}, {"out_of_gamut_share", number(g.profile->out_of_gamut_share)}};
  return out;
}

Json result_json(const LineConfig& c, const LineRun& run) {
  const auto& b = c.basics;
  const auto& r = run.sync.registration;
  const auto size = green_size(b);
  return {{"stages", stages_json(run)},
          {"mass",
           {{"feed_commands_kg", number(run.chain.commands_mass_kg)},
            {"slab_strip_kg", number(run.chain.slab_mass_kg)},
            {"bed_kg_m2", number(b.bed_mass_kg_m2)}}},
          {"slab",
           {{"green_width_mm", millimetres(size.width_m)},
            {"green_length_mm", millimetres(size.length_m)},
            {"top_bottom_offset_mm", millimetres(run.top_bottom_offset_m)},
            {"polish_depth_mm", millimetres(c.vein_map.polish_depth_m)}}},
          {"graphic", graphic_json(run.graphic)},
          {"registration",
           {{"success", r.success},
            {"reason", r.reason},
            {"confidence", number(r.confidence)},
            {"internal_residual_mm", millimetres(r.internal_residual_m)},
            {"gates", gates_json(r.gates)},
            {"against_simulation_mm",
             {{"before", {{"median", millimetres(run.sync.error_before.median_m)}, {"p95", millimetres(run.sync.error_before.p95_m)}}},
              {"after", {{"median", millimetres(run.sync.error_after.median_m)}, {"p95", millimetres(run.sync.error_after.p95_m)}}}}}}},
          {"placeholders", placeholders_json(c)},
          {"warnings", run.warnings},
          {"figures", figures_json(run)}};
}
}  // namespace

void write_score_json(const std::filesystem::path& file, const LineConfig& c, const SyncResult& s) {
  sync::ScoreReport report;
  report.before = s.before;
  report.after = s.after;
  report.best_reachable = s.best;
  report.body_edge = s.body_edge;
  report.print_edge = s.print_edge;
  report.visibility = s.visibility;
  report.zones = s.zones;
  report.tolerance = c.sync.zones.tolerance;
  report.before_definition = "the graphic printed as designed: its first corner on the slab's, unturned, sized for the dried slab";
  report.after_definition = "the graphic moved by the registration's print_from_green";
  report.best_reachable_definition =
      "the graphic moved by the simulation's own displacement (press, cut, belt jitter, mean shift of the layer that is seen): a reference, not a "
      "strict bound; what is left is mostly blur and the simplification of the veins";
  write_text_atomically(file, sync::score_json_text(report, s.registration));
}

void write_run_json(const std::filesystem::path& file, const LineConfig& c, const LineRun& run, const Context& context) {
  Json timing = Json::object();
  double total = 0;
  for (const auto& [phase, seconds] : run.timing_s) timing[phase + "_s"] = seconds, total += seconds;
  timing["total_s"] = total;
  const Json out{{"format", "venato-run"},
                 {"version", 1},
                 {"input", Json::parse(c.resolved_json)},
                 {"result", result_json(c, run)},
                 {"system",
                  {{"code_version", version_string()},
                   {"seed", c.basics.seed},
                   {"config_file", std::filesystem::absolute(c.file).string()},
                   {"config_sha256", sha256_hex(c.resolved_json)},
                   {"threads", context.threads},
                   {"cpu", cpu_model_name()},
                   {"cores", available_cores()},
                   {"peak_memory_bytes", peak_memory_bytes()}}},
                 {"timing", timing}};
  write_text_atomically(file, out.dump(2) + "\n");
}
}  // namespace venato::line
