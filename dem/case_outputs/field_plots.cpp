#include "dem/case_outputs/field_plots.h"

#include <cmath>

#include "base/plot/svg_plot.h"

namespace venato::dem {
namespace {
constexpr double kMm = 1e3;

Series line(std::string label, std::vector<double> x, std::vector<double> y) {
  Series s;
  s.label = std::move(label);
  s.x = std::move(x);
  s.y = std::move(y);
  return s;
}
}  // namespace

std::string plateau_svg(const std::string& title, const PlateauScan& scan, double width_m) {
  std::size_t used = 0;  // the width nearest to the one in use
  for (std::size_t k = 0; k < scan.width_m.size(); ++k)
    if (std::abs(scan.width_m[k] - width_m) < std::abs(scan.width_m[used] - width_m)) used = k;
  std::vector<double> width;
  for (const double w : scan.width_m) width.push_back(w * kMm);
  Plot plot;
  plot.title = title + ": fields against the width of the kernel";
  plot.x_label = "width w [mm]";
  plot.y_label = "value / value at the width used [1]";
  const auto add = [&](const char* label, const std::vector<double>& values) {
    if (!(std::abs(values[used]) > 0)) return;
    std::vector<double> ratio;
    for (const double v : values) ratio.push_back(v / values[used]);
    plot.series.push_back(line(label, width, ratio));
  };
  add("density", scan.density_kg_m3);
  add("vertical stress", scan.stress_zz_pa);
  add("temperature", scan.temperature_m2_s2);
  return svg_plot(plot);
}

std::string stress_profile_svg(const std::string& title, const ContinuumFields& f) {
  std::vector<double> z, vertical, pressure;
  const double columns = static_cast<double>(f.grid.n[0]) * f.grid.n[1];
  for (int k = 0; k < f.grid.n[2]; ++k) {
    double zz = 0, p = 0;
    for (int j = 0; j < f.grid.n[1]; ++j)
      for (int i = 0; i < f.grid.n[0]; ++i) {
        const std::size_t c = f.grid.index(i, j, k);
        zz -= (f.kinetic_stress_pa[c][8] + f.contact_stress_pa[c][8]) / columns;
        p += f.pressure_pa(c) / columns;
      }
    z.push_back(f.grid.centre_m(2, k) * kMm), vertical.push_back(zz), pressure.push_back(p);
  }
  Plot plot;
  plot.title = title + ": stress against height";
  plot.x_label = "stress, compression positive [Pa]";
  plot.y_label = "height z [mm]";
  plot.series.push_back(line("vertical", vertical, z));
  plot.series.push_back(line("pressure", pressure, z));
  return svg_plot(plot);
}
}  // namespace venato::dem
