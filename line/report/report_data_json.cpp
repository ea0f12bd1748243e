#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "line/report/report_data.h"
namespace venato::line {
namespace {
using Json = nlohmann::ordered_json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
double number(const Json& j) { return j.is_number() ? j.get<double>() : std::numeric_limits<double>::quiet_NaN(); }

Json read_json(const std::filesystem::path& file) {
  const auto text = read_file(file);
  auto json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) throw UsageError(file.string() + ": not a JSON object; is this the folder of a finished run?");
  return json;
}

std::string plain(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%g", v);
  return text;
}

/// NaN where nothing was looked at: no colours, not registered, best_reachable.
double visible_percent(const Json& details, const char* which, double distance_m) {
  const auto v = details.find("visibility");
  if (v == details.end() || !v->is_object() || !v->contains(which) || !v->at(which).is_array()) return kNone;
  for (const Json& seen : v->at(which))
    if (number(seen.at("distance_m")) == distance_m) return number(seen.at("visible_length_percent"));
  return kNone;
}

ReportMetrics metrics(const Json& score, const char* which) {
  const Json& m = score.at(which);
  const Json& more = score.at("details").at(which);
  const auto detail = [&](const char* key) {
    return more.is_object() && more.contains(key) ? number(more.at(key)) : std::numeric_limits<double>::quiet_NaN();
  };
  return {number(m.at("centreline_error_mm").at("median")),
          number(m.at("centreline_error_mm").at("p95")),
          detail("centreline_offset_mm"),
          number(m.at("matched_length")),
          number(m.at("boundary_f1").at("1mm")),
          number(m.at("boundary_f1").at("2mm")),
          number(m.at("boundary_f1").at("3mm")),
          number(m.at("dice")),
          detail("missing_length_mm"),
          detail("extra_length_mm"),
          detail("missing_length_percent"),
          detail("extra_length_percent"),
          detail("centreline_max_mm"),
          detail("cl_dice"),
          detail("assd_mm"),
          detail("hd95_mm"),
          detail("area_error_percent"),
          detail("width_error_mm"),
          detail("direction_coherence"),
          visible_percent(score.at("details"), which, 1)};
}

std::map<std::string, double> numbers(const Json& object) {
  std::map<std::string, double> out;
  for (const auto& [name, value] : object.items()) out[name] = number(value);
  return out;
}

std::string joined_names(const Json& array, const char* extra = nullptr) {
  std::string out;
  for (const auto& e : array) {
    out += (out.empty() ? "" : ", ") + e.at("name").get<std::string>();
    if (extra) out += " (" + e.at(extra).get<std::string>() + ")";
  }
  return out;
}

std::string colours_text(const Json& graphic) {
  std::string out;
  if (graphic.at("layers_of_inks").get<int>() > 0) out = "inks of the graphic as they are";
  if (graphic.at("layers_separated").get<int>() == 0) return out;
  out += out.empty() ? "" : "; pictures ";
  const auto& p = graphic.at("profile");
  if (p.is_null()) return out + "separated by the inks' solids: a preview, not colour managed";
  char share[40];
  std::snprintf(share, sizeof share, "%.1f %%", 100 * number(p.at("out_of_gamut_share")));
  std::string intent = p.at("intent");
  std::replace(intent.begin(), intent.end(), '_', ' ');
  return out + "separated by the ICC profile “" + p.at("description").get<std::string>() + "”, " + intent + "; " + share +
         " of the picture is out of the inks' gamut";
}

void read_asked(const Json& in, const Json& graphic, ReportData& d) {
  const auto& slab = in.at("slab");
  d.asked = {{"Slab, fired", plain(number(slab.at("fired_width_mm"))) + " × " + plain(number(slab.at("fired_length_mm"))) + " × " +
                                 plain(number(slab.at("fired_thickness_mm"))) + " mm"},
             {"Powders", joined_names(in.at("powders"), "role")},
             {"Belt speed", plain(number(in.at("belt_speed_m_s")) * 60) + " m/min"},
             {"Bed grid", plain(number(in.at("grid").at("pitch_mm"))) + " mm, " + plain(number(in.at("grid").at("layers"))) + " layers"},
             {"Inks", joined_names(graphic.at("inks"))},
             {"Colours", colours_text(graphic)},
             {"Print", plain(number(in.at("graphic").at("print_dpi"))) + " dpi"},
             {"Polishing depth", plain(number(in.at("vein_map").at("polish_depth_mm"))) + " mm"}};
  std::string chain;
  for (const auto& stage : in.at("chain")) chain += (chain.empty() ? "" : " → ") + stage.at("stage").get<std::string>();
  d.asked.emplace_back("Chain", chain);
  const auto& p = in.at("graphic").at("placement");
  if (number(p.at("dx_mm")) != 0 || number(p.at("dy_mm")) != 0 || number(p.at("rotation_deg")) != 0)
    d.asked.emplace_back("Trial move of the graphic",
                         plain(number(p.at("dx_mm"))) + " mm, " + plain(number(p.at("dy_mm"))) + " mm, " + plain(number(p.at("rotation_deg"))) + "°");
  d.title = in.value("title", "");
}

void read_result(const Json& r, ReportData& d) {
  for (const auto& s : r.at("stages"))
    d.stages.push_back({s.at("name"), number(s.at("wall_s")), number(s.at("mass_in_kg")), number(s.at("mass_out_kg")), s.at("cached"),
                        numbers(s.at("kpi")), numbers(s.at("operator").at("figures")),
                        s.at("operator").at("warnings").get<std::vector<std::string>>()});
  d.feed_kg = number(r.at("mass").at("feed_commands_kg"));
  d.slab_kg = number(r.at("mass").at("slab_strip_kg"));
  d.top_bottom_mm = number(r.at("slab").at("top_bottom_offset_mm"));
  const auto& reg = r.at("registration");
  d.internal_residual_mm = number(reg.at("internal_residual_mm"));
  d.true_median_mm = number(reg.at("against_simulation_mm").at("after").at("median"));
  d.true_p95_mm = number(reg.at("against_simulation_mm").at("after").at("p95"));
  for (const auto& g : reg.at("gates"))
    d.gates.push_back({g.at("name"), g.at("meaning"), number(g.at("value")), number(g.at("limit")), g.at("passed")});
  for (const auto& p : r.at("placeholders")) d.placeholders.push_back({p.at("pointer"), p.at("value"), p.at("unit"), p.at("help")});
  d.warnings = r.at("warnings").get<std::vector<std::string>>();
  for (const auto& f : r.at("figures")) d.figures.push_back({f.at("file"), f.at("section"), f.at("title"), f.at("caption")});
}

void read_run(const Json& run, ReportData& d) {
  if (run.value("format", "") != "venato-run" || run.value("version", 0) != 1) throw UsageError("format is not venato-run version 1");
  read_asked(run.at("input"), run.at("result").at("graphic"), d);
  read_result(run.at("result"), d);
  const auto& system = run.at("system");
  d.code_version = system.at("code_version");
  d.seed = std::to_string(system.at("seed").get<std::uint64_t>());
  d.config_file = system.at("config_file");
  d.config_sha256 = system.at("config_sha256");
  d.cpu = system.at("cpu");
  d.threads = system.at("threads");
  d.peak_memory_gib = number(system.at("peak_memory_bytes")) / 1073741824.0;
  for (const auto& [phase, seconds] : run.at("timing").items()) d.timing_s.emplace_back(phase, number(seconds));
}

void read_score(const Json& score, ReportData& d) {
  d.before = metrics(score, "before");
  d.after = metrics(score, "after");
  d.best = metrics(score, "best_reachable");
  if (const auto& details = score.at("details"); details.contains("edge_width_10_90_mm")) {
    const auto& edge = details.at("edge_width_10_90_mm");
    if (edge.at("body").is_object()) d.body_edge_mm = number(edge.at("body").at("median"));
    if (edge.at("print").is_object()) d.print_edge_mm = number(edge.at("print").at("median"));
  }
  const auto& v = score.at("verdict");
  const auto& t = v.at("tolerance");
  d.verdict = {v.at("slab"),
               number(t.at("good_median_mm")),
               number(t.at("good_p95_mm")),
               number(t.at("fair_p95_mm")),
               number(t.at("least_matched_length")),
               kNone,
               kNone,
               kNone,
               kNone};
  if (v.contains("interval_95")) {
    const auto &median = v.at("interval_95").at("median_mm"), &p95 = v.at("interval_95").at("p95_mm");
    d.verdict.median_low_mm = number(median.at(0)), d.verdict.median_high_mm = number(median.at(1));
    d.verdict.p95_low_mm = number(p95.at(0)), d.verdict.p95_high_mm = number(p95.at(1));
  }
  for (const auto& z : score.at("details").at("score_zones"))
    d.zones.push_back({z.at("verdict"), number(z.at("x_mm")), number(z.at("y_mm")), number(z.at("width_mm")), number(z.at("height_mm")),
                       number(z.at("median_mm")), number(z.at("p95_mm")), number(z.at("matched_length")), number(z.at("body_length_found"))});
  const auto& r = score.at("registration");
  d.registered = r.at("success");
  d.reason = r.at("reason");
  d.confidence = number(r.at("confidence"));
}
}  // namespace

ReportData read_report_data(const std::filesystem::path& folder) {
  ReportData d;
  const auto read = [&](const char* name, auto&& reader) {
    const auto json = read_json(folder / name);
    try {
      reader(json, d);
    } catch (const Json::exception& e) {
      throw UsageError((folder / name).string() + ": not what this program writes: " + e.what());
    } catch (const UsageError& e) {
      throw UsageError((folder / name).string() + ": " + e.what());
    }
  };
  read("run.json", read_run);
  read("score.json", read_score);
  return d;
}
}  // namespace venato::line
