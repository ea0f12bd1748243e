#include "line/report/report.h"

#include <cmath>
#include <cstdio>
#include <functional>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "line/report/curve_plots.h"
#include "line/report/html.h"
#include "line/report/report_data.h"
#include "line/report/zone_map.h"
namespace venato::line {
namespace {
using Data = ReportData;

std::string format(const char* f, double a, double b = 0, double c = 0) {
  char text[400];
  std::snprintf(text, sizeof text, f, a, b, c);
  return text;
}
std::string fixed(double v, int digits) {
  if (!std::isfinite(v)) return "–";
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, v);
  return text;
}

class Page {
 public:
  Page(std::filesystem::path folder, const Data& data) : folder_(std::move(folder)), d(data) {}
  std::string html();

 private:
  std::string image(const ReportFigure& f, const char* css = "") const {
    const auto bytes = read_file(folder_ / f.file);
    return "<img " + std::string(css) + " alt=\"" + html_escape(f.title) + "\" src=\"" + data_uri(f.file, bytes) + "\">";
  }
  const ReportFigure* find(const std::string& file) const {
    for (const auto& f : d.figures)
      if (f.file == file) return &f;
    return nullptr;
  }
  std::string figure(const ReportFigure& f) const {
    return "<figure>" + image(f) + "<figcaption><b>" + html_escape(f.title) + "</b>" + html_escape(f.caption) + "</figcaption></figure>\n";
  }
  std::string grid(const std::vector<const ReportFigure*>& list, bool plots) const {
    std::string out;
    for (const auto* f : list) out += figure(*f);
    return out.empty() ? "" : std::string("<div class=\"grid") + (plots ? " plots" : "") + "\">" + out + "</div>\n";
  }
  std::vector<const ReportFigure*> select(const std::function<bool(const ReportFigure&)>& want) const {
    std::vector<const ReportFigure*> out;
    for (const auto& f : d.figures)
      if (want(f)) out.push_back(&f);
    return out;
  }
  std::string verdict() const;
  std::string scores() const;
  std::string overlay() const;
  std::string asked() const;
  std::string slab() const;
  std::string stages() const;
  std::string book() const;
  std::string doubts() const;

  std::filesystem::path folder_;
  const Data& d;
};

std::string Page::verdict() const {
  if (!d.registered)
    return "<div class=\"verdict bad\"><strong>Not synchronised</strong>The graphic could not be matched to the slab: " + html_escape(d.reason) +
           ". The print files are as designed; do not expect print and body to line up.</div>\n";
  struct Head {
    const char *verdict, *kind, *text;
  };
  constexpr Head kHeads[] = {{"good", "good", "Within tolerance"},
                             {"fair", "fair", "Acceptable, not yet good"},
                             {"low_match", "bad", "Too few veins line up"},
                             {"bad", "bad", "Outside tolerance"},
                             {"no_evidence", "bad", "No veins to judge by"}};
  const Head* head = &kHeads[4];
  for (const Head& h : kHeads)
    if (d.verdict.slab == h.verdict) head = &h;
  std::string out = "<div class=\"verdict " + std::string(head->kind) + "\"><strong>" + head->text + "</strong>";
  out += format(
      "After synchronisation half of the vein length lies within %.2f mm of its body vein and 95 %% within %.2f mm, on %.0f %% of the length. ",
      d.after.median_mm, d.after.p95_mm, d.after.matched * 100);
  if (std::isfinite(d.verdict.p95_low_mm))
    out += format("Another slab of this kind would read %.2f to %.2f mm ", d.verdict.median_low_mm, d.verdict.median_high_mm) +
           format("and %.2f to %.2f mm (95 %%, bootstrap over zones). ", d.verdict.p95_low_mm, d.verdict.p95_high_mm);
  out += format("Before it was %.2f mm and %.2f mm on %.0f %%. ", d.before.median_mm, d.before.p95_mm, d.before.matched * 100);
  out += format("With the simulation's own displacement it would be %.2f mm and %.2f mm. ", d.best.median_mm, d.best.p95_mm);
  return out +
         format("Tolerance: median %g mm and P95 %g mm is good, P95 %g mm acceptable", d.verdict.good_median_mm, d.verdict.good_p95_mm,
                d.verdict.fair_p95_mm) +
         format("; at least %.0f %% of the vein length must have a partner.</div>\n", 100 * d.verdict.least_matched);
}

std::string Page::scores() const {
  struct Row {
    const char* name;
    const char* meaning;
    std::function<std::string(const ReportMetrics&)> value;
    bool main;
  };
  const std::vector<Row> rows{
      {"Centre line, median", "mm along the vein normal; 0 is best", [](const auto& m) { return fixed(m.median_mm, 2); }, true},
      {"Centre line, P95", "mm; 95 % of the matched length is closer", [](const auto& m) { return fixed(m.p95_mm, 2); }, true},
      {"Matched length", "% of the print's vein length that found its body vein", [](const auto& m) { return fixed(m.matched * 100, 1); }, true},
      {"Body vein without print", "% of the body's vein length", [](const auto& m) { return fixed(m.missing_percent, 1); }, true},
      {"Print without body vein", "% of the print's vein length", [](const auto& m) { return fixed(m.extra_percent, 1); }, true},
      {"Visibly off from 1 m",
       "% of the print's vein length; S-CIELAB difference above 2.3; on pixels of the vein map, so shifts below one read coarsely",
       [](const auto& m) { return fixed(m.visible_1m_percent, 1); }, false},
      {"Offset", "mm, signed mean: a constant shift shows here", [](const auto& m) { return fixed(m.offset_mm, 2); }, false},
      {"Centre line, largest", "mm; partners are sought within 15 mm", [](const auto& m) { return fixed(m.max_mm, 2); }, false},
      {"Body vein without print", "mm of centre line", [](const auto& m) { return fixed(m.missing_mm, 0); }, false},
      {"Print without body vein", "mm of centre line", [](const auto& m) { return fixed(m.extra_mm, 0); }, false},
      {"Boundary F1 at 1 mm", "0 to 1; outlines that agree within 1 mm", [](const auto& m) { return fixed(m.f1_1, 3); }, false},
      {"Boundary F1 at 2 mm", "", [](const auto& m) { return fixed(m.f1_2, 3); }, false},
      {"Boundary F1 at 3 mm", "", [](const auto& m) { return fixed(m.f1_3, 3); }, false},
      {"clDice", "0 to 1; centre lines that lie inside the other vein", [](const auto& m) { return fixed(m.cl_dice, 3); }, false},
      {"Dice", "0 to 1; shared vein area", [](const auto& m) { return fixed(m.dice, 3); }, false},
      {"ASSD", "mm between outlines, mean; flatters errors near the vein width", [](const auto& m) { return fixed(m.assd_mm, 2); }, false},
      {"HD95", "mm between outlines, 95th percentile", [](const auto& m) { return fixed(m.hd95_mm, 2); }, false},
      {"Vein area", "% more (+) or less (-) than the body's", [](const auto& m) { return fixed(m.area_percent, 1); }, false},
      {"Vein width", "mm wider (+) or narrower (-) than the body's, median", [](const auto& m) { return fixed(m.width_mm, 2); }, false},
      {"Direction", "-1 to 1; 1 = parallel where both lie", [](const auto& m) { return fixed(m.direction, 3); }, false}};
  std::string out =
      "<div class=\"scroll score\"><table><tr><th>Score</th><th class=\"n\">before</th><th class=\"n\">after</th><th class=\"n\">best "
      "reachable</th><th>meaning</th></tr>\n";
  for (const auto& r : rows)
    out += std::string(r.main ? "<tr class=\"main\">" : "<tr>") + "<td>" + r.name + "</td><td class=\"n\">" + r.value(d.before) +
           "</td><td class=\"n\">" + r.value(d.after) + "</td><td class=\"n\">" + r.value(d.best) + "</td><td>" + r.meaning + "</td></tr>\n";
  out += "</table></div>\n";
  if (std::isfinite(d.body_edge_mm))
    out += "<p>Half of the body's vein edges rise from 10 to 90 % within " + fixed(d.body_edge_mm, 1) +
           " mm (the plan's vein edges of the graphic: " + fixed(d.print_edge_mm, 1) + " mm).</p>\n";
  return out +
         "<p class=\"sub\">Distances count on matched length only, so read them with the matched length. Best reachable uses the "
         "displacement that the simulation itself produced; "
         "it is a reference, not a strict bound: the print is moved by the mean displacement of the layer that is seen, and what is left is mostly "
         "blur and the simplification of the veins.</p>\n";
}

std::string Page::overlay() const {
  std::string out = "<h2 id=\"sync\">Print on body</h2>\n";
  const auto *before = find("figures/overlay_before.png"), *after = find("figures/overlay_after.png");
  if (before && after) {
    out +=
        "<p>Move the pointer or finger across the picture: left of the line before, right of it after synchronisation.</p>\n"
        "<div class=\"slider\">" +
        image(*after, "class=\"under\"") + image(*before, "class=\"top\"") +
        "<span class=\"bar\"></span><span class=\"tag l\">before</span><span class=\"tag r\">after</span>"
        "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"0.5\" aria-label=\"before and after\"></div>\n"
        "<p class=\"key\"><span><i style=\"background:#56b4e9\"></i>body vein only</span><span><i style=\"background:#e69f00\"></i>print vein "
        "only</span>"
        "<span><i style=\"background:#2d2d32\"></i>both</span></p>\n";
  }
  out += zone_map_html(d);
  out += grid(
      select([](const auto& f) { return f.section == "sync" && f.file != "figures/overlay_before.png" && f.file != "figures/overlay_after.png"; }),
      false);
  if (!d.gates.empty()) {
    out += format("<h3>How the registration was judged</h3><p>Confidence %.2f. ", d.confidence) +
           (std::isfinite(d.true_median_mm)
                ? format("Against the simulation's own displacement its error over the vein area is %.2f mm (median) and %.2f mm (P95).",
                         d.true_median_mm, d.true_p95_mm)
                : std::string()) +
           "</p>\n<div class=\"scroll\"><table><tr><th>Gate</th><th class=\"n\">value</th><th class=\"n\">limit</th><th></th><th>meaning</th></tr>\n";
    for (const auto& g : d.gates)
      out += "<tr><td>" + html_escape(g.name) + "</td><td class=\"n\">" + pretty_number(g.value, "") + "</td><td class=\"n\">" +
             pretty_number(g.limit, "") + "</td><td class=\"" + (g.passed ? "pass\">passed" : "fail\">failed") + "</td><td>" +
             html_escape(g.meaning) + "</td></tr>\n";
    out += "</table></div>\n";
  }
  return out;
}

std::string Page::asked() const {
  std::string out = "<h2 id=\"asked\">What was asked</h2>\n<div class=\"scroll\"><table>\n";
  for (const auto& [label, value] : d.asked) out += "<tr><th>" + html_escape(label) + "</th><td>" + html_escape(value) + "</td></tr>\n";
  return out + "</table></div>\n" + grid(select([](const auto& f) { return f.section == "asked"; }), false);
}

std::string Page::slab() const {
  std::string out = "<h2 id=\"slab\">The slab that the line makes</h2>\n";
  if (std::isfinite(d.top_bottom_mm))
    out += format("<p>The veins of the bottom lie %.1f mm ", std::abs(d.top_bottom_mm)) + (d.top_bottom_mm < 0 ? "upstream" : "downstream") +
           " of those of the face.</p>\n";
  for (const auto* name : {"figures/section_along.png", "figures/section_across.png"})
    if (const auto* f = find(name)) out += "<div class=\"wide\">" + figure(*f) + "</div>\n";
  return out + grid(select([](const auto& f) { return f.section == "slab" && f.file.find("section_") == std::string::npos; }), false);
}

std::string Page::stages() const {
  std::string out = "<h2 id=\"stages\">Stage by stage</h2>\n";
  for (const auto& s : d.stages) {
    out += "<h3>" + html_escape(s.name) + "</h3>\n<p class=\"sub\">" +
           (s.cached ? "Operator from the store, no simulation." : "Operator by particle simulation in this run.") + "</p>\n";
    for (const auto& w : s.warnings) out += "<p class=\"fail\">" + html_escape(w) + "</p>\n";
    auto values = s.figures;
    for (const auto& [name, value] : s.kpi) values[name] = value;
    if (!values.empty()) {
      out += "<details" + std::string(values.size() <= 12 ? " open" : "") + "><summary>Figures (" + std::to_string(values.size()) +
             ")</summary><div class=\"scroll\"><table>\n";
      for (const auto& [name, value] : values) {
        const auto n = split_unit(name);
        out += "<tr><td>" + html_escape(n.words) + "</td><td class=\"n\">" + html_escape(pretty_number(value, n.unit)) + "</td></tr>\n";
      }
      out += "</table></div></details>\n";
    }
    out += grid(select([&](const auto& f) { return f.section == s.name; }), true);
  }
  return out;
}

std::string Page::book() const {
  std::string out =
      "<h2 id=\"book\">Mass book and timings</h2>\n<div class=\"scroll\"><table><tr><th>Stage</th><th class=\"n\">in, kg</th><th class=\"n\">out, "
      "kg</th><th class=\"n\">difference</th>"
      "<th class=\"n\">time, s</th><th>operator</th></tr>\n";
  const auto defect = [](double in, double o) { return in > 0 ? format("%.1e", std::abs(in - o) / in) : std::string("–"); };
  for (const auto& s : d.stages)
    out += "<tr><td>" + html_escape(s.name) + "</td><td class=\"n\">" + fixed(s.mass_in_kg, 4) + "</td><td class=\"n\">" + fixed(s.mass_out_kg, 4) +
           "</td><td class=\"n\">" + defect(s.mass_in_kg, s.mass_out_kg) + "</td><td class=\"n\">" + fixed(s.wall_s, 2) + "</td><td>" +
           (s.cached ? "store" : "simulated") + "</td></tr>\n";
  out += "<tr class=\"main\"><td>feed commands → slab strip</td><td class=\"n\">" + fixed(d.feed_kg, 4) + "</td><td class=\"n\">" +
         fixed(d.slab_kg, 4) + "</td><td class=\"n\">" + defect(d.feed_kg, d.slab_kg) +
         "</td><td></td><td></td></tr></table></div>\n<div class=\"scroll\"><table><tr><th>Phase</th><th class=\"n\">s</th></tr>\n";
  for (const auto& [phase, seconds] : d.timing_s) {
    auto name = split_unit(phase).words;
    out += "<tr" + std::string(name == "total" ? " class=\"main\"" : "") + "><td>" + html_escape(name) + "</td><td class=\"n\">" + fixed(seconds, 2) +
           "</td></tr>\n";
  }
  return out + "</table></div>\n" + format("<p class=\"sub\">%.0f threads, at most %.2f GiB of memory.</p>\n", d.threads, d.peak_memory_gib);
}

std::string Page::doubts() const {
  std::string out = "<h2 id=\"doubts\">What to doubt</h2>\n";
  if (!d.warnings.empty()) {
    out += "<h3>Warnings</h3><ul class=\"plain\">\n";
    for (const auto& w : d.warnings) out += "<li>" + html_escape(w) + "</li>\n";
    out += "</ul>\n";
  }
  if (d.placeholders.empty()) return out + "<p>No placeholder numbers were used.</p>\n";
  out +=
      "<h3>Placeholders</h3><p>These numbers have no public source. Replace them by your plant's before you trust "
      "millimetres.</p>\n<details><summary>" +
      std::to_string(d.placeholders.size()) +
      " placeholder numbers</summary><div class=\"scroll\"><table><tr><th>Key</th><th class=\"n\">value</th><th>unit</th><th>what</th></tr>\n";
  for (const auto& p : d.placeholders)
    out += "<tr><td><code>" + html_escape(p.pointer) + "</code></td><td class=\"n\">" + html_escape(p.value) + "</td><td>" + html_escape(p.unit) +
           "</td><td>" + html_escape(p.help) + "</td></tr>\n";
  return out + "</table></div></details>\n";
}

std::string Page::html() {
  const std::string title = d.title.empty() ? std::filesystem::path(d.config_file).stem().string() : d.title;
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n<title>" +
      html_escape(title) + " – Venato</title>\n<style>" + kReportStyle + "</style></head><body>\n<header><h1>" + html_escape(title) +
      "</h1><p class=\"sub\">Predicted veins of a full-body slab and the print that follows them</p>\n" +
      "<nav><a href=\"#sync\">Print on body</a><a href=\"#asked\">What was asked</a><a href=\"#slab\">The slab</a><a href=\"#stages\">Stages</a><a "
      "href=\"#book\">Mass and time</a>"
      "<a href=\"#doubts\">What to doubt</a></nav></header>\n<main>\n";
  out += verdict() + scores() + overlay() + asked() + slab() + stages() + book() + doubts();
  out += "</main>\n<footer>Venato " + html_escape(d.code_version) + " · seed " + html_escape(d.seed) + " · config <code>" +
         html_escape(d.config_sha256.substr(0, 16)) + "</code> · " + html_escape(d.cpu) + "</footer>\n<script>" + kReportScript +
         "</script>\n</body></html>\n";
  return out;
}
}  // namespace

void write_report(const std::filesystem::path& run_folder) {
  const auto data = read_report_data(run_folder);
  write_text_atomically(run_folder / "report.html", Page(run_folder, data).html());
}
}  // namespace venato::line
