#include "line/report/curve_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
namespace venato::line {
namespace {
/// Name endings and the unit they stand for, longest first so that "_kg_s" is not read as "_s".
constexpr std::array<std::pair<std::string_view, std::string_view>, 23> kUnits{
    {{"_kg_m2_s", "kg/m²/s"}, {"_kg_m2", "kg/m²"}, {"_kg_m3", "kg/m³"}, {"_mm2_s", "mm²/s"}, {"_m2_s", "m²/s"}, {"_rad_s", "rad/s"},
     {"_m_s", "m/s"},         {"_kg_s", "kg/s"},   {"_g_s", "g/s"},     {"_mpa", "MPa"},     {"_kpa", "kPa"},   {"_deg", "°"},
     {"_mm", "mm"},           {"_um", "µm"},       {"_ms", "ms"},       {"_hz", "Hz"},       {"_kg", "kg"},     {"_pa", "Pa"},
     {"_rad", "rad"},         {"_pct", "%"},       {"_n", "N"},         {"_m", "m"},         {"_s", "s"}}};
constexpr std::array<std::string_view, 9> kAbscissas{"time_s", "delay_s", "height_mm", "position_m", "y_m", "z_m", "drive", "solid_fraction", "zeta"};

std::string label(const NamedUnit& n) { return n.unit.empty() ? n.words : n.words + " [" + n.unit + "]"; }

std::string abscissa(const std::map<std::string, std::vector<double>>& columns) {
  for (auto name : kAbscissas)
    if (columns.contains(std::string(name))) return std::string(name);
  return columns.begin()->first;
}
}  // namespace

NamedUnit split_unit(const std::string& name) {
  NamedUnit out{name, ""};
  for (const auto& [ending, unit] : kUnits)
    if (name.size() > ending.size() && name.ends_with(ending)) {
      out = {name.substr(0, name.size() - ending.size()), std::string(unit)};
      break;
    }
  std::replace(out.words.begin(), out.words.end(), '_', ' ');
  return out;
}

std::vector<Plot> plots_of_curve(const std::string& title, const std::map<std::string, std::vector<double>>& columns) {
  std::vector<Plot> plots;
  if (columns.size() < 2) return plots;
  const std::string x = abscissa(columns);
  const auto& x_values = columns.at(x);
  std::map<std::string, std::size_t> of_unit;
  for (const auto& [name, values] : columns) {
    if (name == x || values.size() != x_values.size() || values.empty()) continue;
    const auto named = split_unit(name);
    const auto [it, fresh] = of_unit.try_emplace(named.unit, plots.size());
    if (fresh) plots.push_back({title, label(split_unit(x)), label(named), {}, {}, {}});
    auto& plot = plots[it->second];
    if (!fresh) plot.y_label = named.unit.empty() ? "value" : "[" + named.unit + "]";
    Series s;
    s.label = named.words;
    s.x = x_values;
    s.y = values;
    if (values.size() <= 8) s.style = SeriesStyle::points;
    plot.series.push_back(std::move(s));
  }
  return plots;
}

std::vector<Plot> plots_of_kernel(const Operator& op) {
  std::vector<Plot> plots;
  std::vector<double> theta(static_cast<std::size_t>(op.n_theta), 0.0), eta(static_cast<std::size_t>(op.n_eta), 0.0);
  for (int a = 0; a < op.nz_in; ++a)
    for (int b = 0; b < op.nz_out; ++b)
      for (int t = 0; t < op.n_theta; ++t)
        for (int e = 0; e < op.n_eta; ++e) {
          const double w = op.weight[op.index(a, b, t, e)] / op.nz_in;
          theta[static_cast<std::size_t>(t)] += w;
          eta[static_cast<std::size_t>(e)] += w;
        }
  const auto add = [&](const char* title, const char* axis, const std::vector<double>& share, double start, double step, double unit) {
    if (share.size() < 2) return;
    Series s{"share of mass", {}, {}, {}, {}, SeriesStyle::steps, ""};
    for (std::size_t k = 0; k < share.size(); ++k) s.x.push_back((start + (static_cast<double>(k) + 0.5) * step) * unit), s.y.push_back(share[k]);
    plots.push_back({title, axis, "share of mass per cell", {s}, {}, {}});
  };
  add("Kernel: delay about the mean", "delay [ms]", theta, op.theta0_s, op.dtheta_s, 1e3);
  add("Kernel: shift across the belt", "shift [mm]", eta, op.eta0_m, op.deta_m, 1e3);
  return plots;
}

Plot residual_plot(const std::vector<std::pair<std::string, std::vector<sync::ResidualSample>>>& sets) {
  Plot plot{"Share of the vein centre line within a distance",
            "distance along the vein normal [mm]",
            "share of matched length",
            {},
            std::pair{0.0, 10.0},
            std::pair{0.0, 1.0}};
  for (const auto& [name, samples] : sets) {
    std::vector<double> d;
    for (const auto& s : samples)
      if (s.matched) d.push_back(std::abs(s.signed_distance_m) * 1e3);
    if (d.empty()) continue;
    std::sort(d.begin(), d.end());
    Series series;
    series.label = name;
    constexpr int kPoints = 201;  // every 0.05 mm up to 10 mm
    for (int k = 0; k < kPoints; ++k) {
      const double x = 10.0 * k / (kPoints - 1);
      series.x.push_back(x);
      series.y.push_back(static_cast<double>(std::upper_bound(d.begin(), d.end(), x) - d.begin()) / static_cast<double>(d.size()));
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}
}  // namespace venato::line
