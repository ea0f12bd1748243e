#include "dem/coarse_graining/openings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

namespace venato::dem {

double mean_volume_grain_m(const SizeDistribution& psd, double coarse_graining) {
  return std::cbrt(6 / std::numbers::pi * mean_grain_mass(psd, 1.0, coarse_graining));
}

double mean_volume_grain_m(const Case& c) {
  double largest = 0;
  for (const Powder& p : c.powders) largest = std::max(largest, mean_volume_grain_m(p.psd, c.coarse_graining));
  return largest;
}

double coarse_flow_factor(double opening, double grain, double cg, bool slot) {
  const double real = opening - kBeverlooEmptyAnnulus * grain, coarse = opening - kBeverlooEmptyAnnulus * cg * grain;
  if (!(real > 0)) return std::numeric_limits<double>::quiet_NaN();
  return coarse > 0 ? std::pow(coarse / real, slot ? 1.5 : 2.5) : 0;
}

double coarse_graining_for(double factor, double opening, double grain, bool slot) {
  return (opening - std::pow(factor, slot ? 1 / 1.5 : 1 / 2.5) * (opening - kBeverlooEmptyAnnulus * grain)) / (kBeverlooEmptyAnnulus * grain);
}

std::string opening_warning(std::string_view name, double opening, bool slot, double grain, double cg) {
  const double ratio = opening / (cg * grain), factor = coarse_flow_factor(opening, grain, cg, slot);
  const bool few = ratio < kFewestGrainsPerOpening;
  if (!few && factor >= kAcceptedFlowFactor) return {};
  char text[400];
  int n = std::snprintf(text, sizeof text, "%.*s of %.3g mm is %.1f coarse grains wide (%.3g mm each)%s", static_cast<int>(name.size()), name.data(),
                        opening * 1e3, ratio, cg * grain * 1e3, few ? ", fewer than the 6 that flow needs" : "");
  const auto rest = [&](const char* format, auto... values) {
    std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), format, values...);
  };
  const double six = opening / (kFewestGrainsPerOpening * grain), ten_percent = coarse_graining_for(kAcceptedFlowFactor, opening, grain, slot);
  if (std::isnan(factor))
    rest("; not even the real grains (%.3g mm) would flow through it by Beverloo's law", grain * 1e3);
  else if (six < 1)
    rest("; even the real grains (%.3g mm) are too large for steady flow", grain * 1e3);
  else
    rest("; by Beverloo's law it passes %.2f of the flow of real grains: use coarse_graining <= %.2f, for less than 10 %% error <= %.2f", factor, six,
         std::min(six, ten_percent));
  return text;
}

std::string layer_warning(double thickness, double grain, double cg) {
  const double ratio = thickness / (cg * grain);
  if (!(thickness > 0) || ratio >= kFewestGrainsPerLayer) return {};
  char text[256];
  std::snprintf(text, sizeof text,
                "the layer of %.3g mm is %.1f coarse grains thick (%.3g mm each), fewer than 10: its surface and floor shape the result; ",
                thickness * 1e3, ratio, cg * grain * 1e3);
  std::string out = text;
  if (cg > 1) {
    std::snprintf(text, sizeof text, "use coarse_graining <= %.2g", std::max(1.0, thickness / (kFewestGrainsPerLayer * grain)));
    out += text;
  } else {
    out += "the real grains are that large";
  }
  return out;
}

std::vector<std::string> coarse_graining_warnings(const Case& c) {
  std::vector<std::string> warnings;
  if (c.powders.empty()) return warnings;
  const double grain = mean_volume_grain_m(c) / c.coarse_graining;
  const auto add = [&](std::string text) {
    if (!text.empty()) warnings.push_back(std::move(text));
  };
  for (const Opening& o : c.openings) add(opening_warning(o.name, o.size_m, o.slot, grain, c.coarse_graining));
  add(layer_warning(c.layer_thickness_m, grain, c.coarse_graining));
  return warnings;
}
}  // namespace venato::dem
