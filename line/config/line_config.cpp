#include "line/config/line_config.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "line/chain/order.h"
#include "line/config/sections.h"
namespace venato::line {
namespace {

void read_chain(ObjectReader& r, LineConfig& c, const std::vector<StageDescriptor>& stages) {
  r.objects("chain", "the stages in the order of the line", 1, 12, [&](ObjectReader& o, std::size_t index) {
    ++c.chain_entries;
    std::vector<ObjectReader::Branch> branches;
    for (const auto& d : stages) {
      branches.push_back({std::string(d.name), std::string(d.help), [&c, &d, index](ObjectReader& section) {
                            Stage stage = d.read(section);
                            if (stage.name.empty()) stage.name = std::string(d.name);
                            if (!section.describing())
                              c.chain.push_back({&d, std::move(stage), std::string("/chain/").append(std::to_string(index)), ""});
                          }});
    }
    o.pick("stage", "which stage", branches);
  });
}

void read_jitter(ObjectReader& r, BeltJitter& j) {
  r.number("amplitude_mm", j.amplitude_m, {0, 20, "mm"}, {"root mean square of the displacement along the belt", 0.0, true});
  r.number("correlation_mm", j.correlation_m, {50, 5000, "mm"}, {"correlation length along the belt", 400.0, true});
  // Slopes of a Gaussian field are sqrt(2) amplitude / correlation (rms); at 5 % a 5-sigma slope is still far from folding the bed.
  if (j.amplitude_m > 0.05 * j.correlation_m)
    r.issue("amplitude_mm", "more than 5 % of correlation_mm: no belt stretches so much", "raise correlation_mm or lower amplitude_mm");
}

/// Two stages of one kind in a chain need two names: names are keys in run.h5 and in the report.
void number_repeated_stages(std::vector<ConfiguredStage>& chain) {
  for (std::size_t i = 0; i < chain.size(); ++i) {
    int seen = 1;
    for (std::size_t j = 0; j < i; ++j) seen += chain[j].descriptor == chain[i].descriptor;
    if (seen > 1) chain[i].stage.name.append("_").append(std::to_string(seen));
  }
}

/// The saw must stay on the strip, otherwise the run would end in an error after the simulations.
void check_cut(const LineBasics& b, std::vector<ConfigIssue>& issues) {
  const double width = b.fired_width_m * b.green_from_design(), length = b.fired_length_m * b.green_from_design(),
               turn = std::abs(std::sin(b.cut_rotation_rad));
  const double room = b.trim_m * (1 + b.nominal_springback);
  const double reach = std::max(std::abs(b.cut_offset_x_m) + turn * length, std::abs(b.cut_offset_y_m) + turn * width);
  if (reach <= room) return;
  char text[160];
  std::snprintf(text, sizeof text, "the cut slab reaches %.1f mm beyond its nominal outline, the strip only %.1f mm", reach * 1e3, room * 1e3);
  issues.push_back({"/cut", text, "raise grid/trim_mm or lower the offset and rotation of the cut"});
}

LineConfig finish(LineConfig c, ReadOutcome outcome, const std::vector<StageDescriptor>& stages) {
  // An entry with a bad "stage" is missing from c.chain; the order is judged only when every entry is known.
  if (c.chain.size() == c.chain_entries && !c.chain.empty()) {
    const auto issues = check_chain_order(c.chain, stages);
    outcome.issues.insert(outcome.issues.end(), issues.begin(), issues.end());
  }
  outcome.throw_if_bad();
  number_repeated_stages(c.chain);
  for (auto& s : c.chain) s.inputs_json = outcome.subtree(s.pointer);
  c.resolved_json = outcome.resolved_json;
  c.placeholders = outcome.placeholders;
  derive_basics(c);
  check_cut(c.basics, outcome.issues);
  outcome.throw_if_bad();
  return c;
}
}  // namespace

void read_line_config(ObjectReader& r, LineConfig& c, const std::vector<StageDescriptor>& stages) {
  int format = 0, version = 0;
  auto& b = c.basics;
  r.choice("format", format, {{"venato-line", 0}}, {"kind of file"});
  r.integer("version", version, {1, 1, "1", "this program reads version 1"}, {"of the file format"});
  r.text("title", c.title, {"shown in the report", ""});
  r.seed("seed", b.seed, {"of every random number of the run"});
  r.number("belt_speed_m_s", b.belt_speed_m_s, {0.005, 1, "m/s"}, {"of the compactor belt (6 m/min = 0.1 m/s)"});
  r.object("slab", "the slab to make, at fired size", [&](ObjectReader& o) { read_slab(o, b); });
  read_powders(r, b);
  r.object("materials", "for the particle simulation", [&](ObjectReader& o) { read_materials(o, b); });
  r.object(
      "grid", "of the powder bed", [&](ObjectReader& o) { read_grid(o, c); }, false);
  r.integer("bootstrap_replicates", b.bootstrap_replicates, {0, 200, "1"}, {"resamples of every operator, for error bars", 16});
  r.object("design", "what the dosing heads follow", [&](ObjectReader& o) { read_design(o, c.design); });
  r.object("graphic", "what the inkjet prints", [&](ObjectReader& o) { read_graphic(o, c.graphic); });
  read_chain(r, c, stages);
  r.object(
      "belt_jitter", "slow random stretch of the belt between dosing and press", [&](ObjectReader& o) { read_jitter(o, c.belt_jitter); }, false);
  r.object(
      "cut", "where the slab is cut from the strip", [&](ObjectReader& o) { read_cut(o, b); }, false);
  r.object(
      "vein_map", "what is looked at", [&](ObjectReader& o) { read_vein_map(o, c.vein_map); }, false);
  r.object(
      "sync", "registration and score", [&](ObjectReader& o) { read_sync(o, c.sync); }, false);
  r.object(
      "masks", "printer files", [&](ObjectReader& o) { read_masks(o, c.masks); }, false);
  if (c.vein_map.polish_depth_m >= b.fired_thickness_m)
    r.issue("vein_map", "polish_depth_mm takes off the whole slab", "keep it below slab/fired_thickness_mm");
}

ReadRoot line_config_root(const std::vector<StageDescriptor>& stages) {
  return [&stages](ObjectReader& r) {
    LineConfig c;
    read_line_config(r, c, stages);
  };
}

LineConfig load_line_config(const std::filesystem::path& file, const std::vector<Override>& overrides, const std::vector<StageDescriptor>& stages) {
  LineConfig c;
  auto outcome = read_config_file(file, overrides, [&](ObjectReader& r) { read_line_config(r, c, stages); });
  c.file = file;
  return finish(std::move(c), std::move(outcome), stages);
}

LineConfig load_line_config_text(std::string_view json, const std::filesystem::path& folder, const std::vector<Override>& overrides,
                                 const std::vector<StageDescriptor>& stages) {
  LineConfig c;
  auto outcome = read_config_text(json, folder, overrides, [&](ObjectReader& r) { read_line_config(r, c, stages); });
  c.file = folder / "config.json";
  return finish(std::move(c), std::move(outcome), stages);
}
}  // namespace venato::line
