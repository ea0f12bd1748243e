#include "line/report/zone_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
namespace venato::line {
namespace {
struct Look {
  const char *verdict, *fill, *text;
};
// Wong's colour-blind-safe colours, lightened; the number and the sign stand for those who print in grey.
constexpr Look kLooks[] = {{"good", "#b7e0d2", "good"},
                           {"fair", "#f7e3a1", "acceptable"},
                           {"bad", "#f1b497", "outside tolerance"},
                           {"low_match", "#d9c2e0", "too few veins line up"},
                           {"no_evidence", "#eceff1", "no veins to judge by"}};
const Look& look(const std::string& verdict) {
  for (const Look& l : kLooks)
    if (verdict == l.verdict) return l;
  return kLooks[4];
}
std::string zone_text(const ReportZone& z) {
  char text[40];
  if (z.verdict == "no_evidence") return "";
  if (z.verdict == "low_match") {
    std::snprintf(text, sizeof text, "%.0f %%", 100 * std::min(std::isfinite(z.matched) ? z.matched : 0, std::isfinite(z.found) ? z.found : 0));
    return text;
  }
  std::snprintf(text, sizeof text, "%.1f", z.p95_mm);
  return text;
}
std::string distances(const ReportZone& z) {
  char text[80];
  if (!std::isfinite(z.median_mm)) return "";
  std::snprintf(text, sizeof text, "; median %.2f mm, P95 %.2f mm", z.median_mm, z.p95_mm);
  return text;
}
}  // namespace

std::string zone_map_html(const ReportData& d) {
  if (d.zones.empty()) return "";
  double width = 0, height = 0;
  for (const ReportZone& z : d.zones) width = std::max(width, z.x_mm + z.width_mm), height = std::max(height, z.y_mm + z.height_mm);
  const double scale = 420 / std::max(width, height);  // px per mm
  char text[600];
  std::snprintf(
      text, sizeof text,
      "<figure class=\"zones\"><svg role=\"img\" aria-label=\"verdict of each zone\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.1f %.1f\">\n",
      width * scale, height * scale, width * scale, height * scale);
  std::string out = text;
  const double font = std::clamp(0.3 * scale * std::min(d.zones.front().width_mm, d.zones.front().height_mm), 5.0, 16.0);
  for (const ReportZone& z : d.zones) {
    std::snprintf(
        text, sizeof text,
        "<g><title>%.0f to %.0f mm across, %.0f to %.0f mm along: %s%s</title><rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" "
        "height=\"%.1f\" fill=\"%s\" stroke=\"#fff\"/><text x=\"%.1f\" y=\"%.1f\" font-size=\"%.1f\" text-anchor=\"middle\">%s</text></g>\n",
        z.x_mm, z.x_mm + z.width_mm, z.y_mm, z.y_mm + z.height_mm, look(z.verdict).text, distances(z).c_str(), z.x_mm * scale, z.y_mm * scale,
        z.width_mm * scale, z.height_mm * scale, look(z.verdict).fill, (z.x_mm + 0.5 * z.width_mm) * scale,
        (z.y_mm + 0.5 * z.height_mm) * scale + 0.35 * font, font, zone_text(z).c_str());
    out += text;
  }
  out +=
      "</svg><figcaption><b>Verdict by zone</b>P95 of the centre-line distance in mm; % where too few veins line up.</figcaption></figure>\n<p "
      "class=\"key\">";
  for (const Look& l : kLooks) {
    const auto n = std::count_if(d.zones.begin(), d.zones.end(), [&](const ReportZone& z) { return z.verdict == l.verdict; });
    out += std::string("<span><i style=\"background:") + l.fill + "\"></i>" + l.text + ": " + std::to_string(n) + "</span>";
  }
  return out + "</p>\n";
}
}  // namespace venato::line
