#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/rigs/support/statistics.h"
#include "dem/rigs/tapped_density/rig.h"

namespace venato::dem::rigs::tapped_density {
namespace {
const double kNan = std::numeric_limits<double>::quiet_NaN();
const std::string kFrom = "6 wedges", kJackknife = "jackknife over 6 wedges";

/// Best straight combination poured, final for a given tau; returns the sum of squared residuals.
double fit_given_tau(const std::vector<double>& density, double tau, double& poured, double& final_density) {
  std::vector<double> x, y;
  for (std::size_t n = 0; n < density.size(); ++n)
    if (std::isfinite(density[n])) x.push_back(std::exp(-static_cast<double>(n) / tau)), y.push_back(density[n]);
  const LineFit line = fit_line(x, y);
  final_density = line.intercept, poured = line.intercept + line.slope;
  return line.rms * line.rms * static_cast<double>(x.size());
}
}  // namespace

std::vector<double> wedge_densities(const Snapshot& s, const Case& c, const Config& config) {
  double mass[kWedges][kRings] = {}, moment[kWedges][kRings] = {};
  for (std::size_t k = 0; k < s.id.size(); ++k) {
    const double x = s.position_m[k].x() - config.centre_x_m, y = s.position_m[k].y() - config.centre_y_m, z = s.position_m[k].z() - config.floor_z_m;
    const double share = (x * x + y * y) / (config.radius_m * config.radius_m);
    if (share >= 1 || z < 0) continue;
    const Powder& powder = c.powders[static_cast<std::size_t>(s.species[k])];
    const double m = c.materials.materials[static_cast<std::size_t>(powder.material)].density_kg_m3 * 4 / 3 * std::numbers::pi *
                     std::pow(static_cast<double>(s.radius_m[k]), 3);
    const int wedge = std::clamp(static_cast<int>((std::atan2(y, x) / (2 * std::numbers::pi) + 0.5) * kWedges), 0, kWedges - 1);
    const int ring = std::min(kRings - 1, static_cast<int>(share * kRings));  // equal areas
    mass[wedge][ring] += m, moment[wedge][ring] += m * z;
  }
  const double area = std::numbers::pi * config.radius_m * config.radius_m / (kWedges * kRings);
  std::vector<double> density;
  for (int w = 0; w < kWedges; ++w) {
    double all = 0, volume = 0;
    for (int k = 0; k < kRings; ++k)
      if (mass[w][k] > 0) all += mass[w][k], volume += area * 2 * moment[w][k] / mass[w][k];
    density.push_back(volume > 0 ? all / volume : kNan);
  }
  return density;
}

TapFit fit_tapping(const std::vector<double>& density) {
  TapFit best{kNan, kNan, kNan, kNan};
  std::vector<double> known;
  for (const double d : density)
    if (std::isfinite(d)) known.push_back(d);
  if (known.size() < 4) return best;
  double variance = 0;
  const double mean = mean_of(known).mean;
  for (const double d : known) variance += (d - mean) * (d - mean);
  if (!(variance > 0)) return best;
  // One-dimensional search over ln tau: a grid first (the sum of squares may have more than one dip), then golden section inside its best cell.
  const double low = std::log(0.2), high = std::log(20.0 * static_cast<double>(density.size()));
  constexpr int kGrid = 80;
  double poured = 0, final_density = 0, at = low, least = HUGE_VAL;
  for (int k = 0; k <= kGrid; ++k) {
    const double t = low + (high - low) * k / kGrid, sum = fit_given_tau(density, std::exp(t), poured, final_density);
    if (sum < least) least = sum, at = t;
  }
  double a = std::max(low, at - (high - low) / kGrid), b = std::min(high, at + (high - low) / kGrid);
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  for (int k = 0; k < 60; ++k) {
    const double p = b - golden * (b - a), q = a + golden * (b - a);
    if (fit_given_tau(density, std::exp(p), poured, final_density) < fit_given_tau(density, std::exp(q), poured, final_density))
      b = q;
    else
      a = p;
  }
  best.tau = std::exp(0.5 * (a + b));
  best.r2 = 1 - fit_given_tau(density, best.tau, best.poured, best.final_density) / variance;
  return best;
}

RigResult measure(const Config& config, const Case& c, const CaseResult& r) {
  RigResult out;
  const auto& frames = r.snapshots.at(config.plan);
  std::vector<std::vector<double>> of_wedge(kWedges);  // [wedge][taps]
  std::vector<double> curve, error;
  for (const Snapshot& s : frames) {
    const auto densities = wedge_densities(s, c, config);
    for (std::size_t w = 0; w < kWedges; ++w) of_wedge[w].push_back(densities[w]);
    const Estimate e = mean_of(densities);
    curve.push_back(e.mean), error.push_back(e.standard_error);
  }
  const TapFit fit = fit_tapping(curve);
  // Errors: of single numbers the scatter of the wedges; of the fit, whose parameters of one wedge alone are too noisy, the jackknife (fits without
  // one wedge each).
  std::vector<double> poured, last, last_ratio, final_density, final_ratio, to_half;
  for (std::size_t w = 0; w < kWedges && !curve.empty(); ++w) {
    poured.push_back(of_wedge[w].front()), last.push_back(of_wedge[w].back()), last_ratio.push_back(last.back() / poured.back());
    std::vector<double> others;
    for (std::size_t n = 0; n < curve.size(); ++n) {
      std::vector<double> rest;
      for (std::size_t v = 0; v < kWedges; ++v)
        if (v != w) rest.push_back(of_wedge[v][n]);
      others.push_back(mean_of(rest).mean);
    }
    const TapFit f = fit_tapping(others);
    final_density.push_back(f.final_density), final_ratio.push_back(f.final_density / others.front()), to_half.push_back(f.tau * std::numbers::ln2);
  }
  const auto se = [](const std::vector<double>& v) { return mean_of(v).standard_error; };
  const auto jackknife = [](const std::vector<double>& v) { return (kWedges - 1) * mean_of(v).standard_error; };
  const double at_rest = curve.empty() ? kNan : curve.front(), tapped = curve.empty() ? kNan : curve.back();
  const std::string taps = std::to_string(curve.empty() ? 0 : curve.size() - 1);
  out.kpis = {{"poured_density_kg_m3", at_rest, se(poured), "kg/m3", "bulk density as poured, before the first tap", kFrom},
              {"tapped_density_kg_m3", tapped, se(last), "kg/m3", "bulk density after " + taps + " taps", kFrom},
              {"hausner_ratio", tapped / at_rest, se(last_ratio), "1", "density after " + taps + " taps over density as poured", kFrom},
              {"final_density_kg_m3", fit.final_density, jackknife(final_density), "kg/m3",
               "limit of the tapping curve: exponential through all taps", kJackknife},
              {"final_hausner_ratio", fit.final_density / at_rest, jackknife(final_ratio), "1", "limit of the tapping curve over density as poured",
               kJackknife},
              {"taps_to_half", fit.tau * std::numbers::ln2, jackknife(to_half), "1",
               "taps after which half of the gain is reached, of the same exponential", kJackknife},
              {"tapping_fit_r2", fit.r2, kNan, "1", "share of the curve's variance that the exponential explains", ""}};
  if (frames.size() < static_cast<std::size_t>(config.taps) + 1)
    out.warnings.push_back("tapped_density: only " + std::to_string(frames.size()) + " of " + std::to_string(config.taps + 1) + " frames are there");
  if (!(fit.tau <= 0.5 * config.taps))
    out.warnings.push_back("tapped_density: the curve has not levelled off within " + std::to_string(config.taps) +
                           " taps; its limit is an extrapolation, use more or higher taps");
  RigTable table{"tapping_curve",
                 {{"taps", "1", "number of taps so far", {}},
                  {"density_kg_m3", "kg/m3", "bulk density", {}},
                  {"standard_error_kg_m3", "kg/m3", "of the density, from 6 wedges", {}},
                  {"fit_kg_m3", "kg/m3", "exponential through all taps", {}}}};
  Series points{"measured", {}, {}, {}, {}, SeriesStyle::points, ""}, line{"exponential", {}, {}, {}, {}, SeriesStyle::line, ""};
  for (std::size_t n = 0; n < curve.size(); ++n) {
    const double model = fit.final_density - (fit.final_density - fit.poured) * std::exp(-static_cast<double>(n) / fit.tau);
    const double row[] = {static_cast<double>(n), curve[n], error[n], model};
    for (std::size_t k = 0; k < 4; ++k) table.columns[k].values.push_back(row[k]);
    points.x.push_back(row[0]), points.y.push_back(row[1]), points.y_low.push_back(row[1] - row[2]), points.y_high.push_back(row[1] + row[2]);
    line.x.push_back(row[0]), line.y.push_back(model);
  }
  Plot plot;
  plot.title = c.name + ": tapping curve";
  plot.x_label = "taps", plot.y_label = "bulk density [kg/m3]";
  plot.series = {points, line};
  out.plots.push_back({"tapping_curve", plot});
  out.tables.push_back(table);
  return out;
}
}  // namespace venato::dem::rigs::tapped_density
