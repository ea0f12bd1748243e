#include "line/press_map/press_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/expects.h"
#include "line/press_map/displacement.h"
#include "line/press_map/lateral_flow.h"
#include "line/press_map/press_gap.h"

namespace venato::line {
namespace {
constexpr double kSmallestAreaRatio = 0.1;  // a column squeezed to a tenth of its area is no longer the small displacement the law is for
constexpr int kGapRounds = 100;
constexpr double kGapSettled = 1e-10;  // l_p follows the gap this closely; mass and mean pressure are exact at any round

void require(bool ok, const char* name, double value, const char* limits) {
  if (!ok) throw UsageError("press: " + std::string(name) + " is " + std::to_string(value) + ", must be " + limits);
}

void check(const std::vector<double>& mass, const BedGrid& grid, const PressMapConfig& c) {
  VENATO_EXPECTS(mass.size() == grid.columns() && grid.pitch_m > 0);
  require(c.peak_pressure_pa > 0 && std::isfinite(c.peak_pressure_pa), "peak_pressure_pa", c.peak_pressure_pa, "> 0");
  require(std::isfinite(c.density_a_kg_m3), "density_a_kg_m3", c.density_a_kg_m3, "a number");
  require(c.density_b_kg_m3 > 0 && std::isfinite(c.density_b_kg_m3), "density_b_kg_m3", c.density_b_kg_m3, "> 0");
  require(c.lateral_length_factor >= 0 && std::isfinite(c.lateral_length_factor), "lateral_length_factor", c.lateral_length_factor, ">= 0");
  require(c.springback > -0.5 && c.springback < 0.5, "springback", c.springback, "a small fraction in (-0.5, 0.5)");
  require(std::isfinite(c.edge_gain_m) && (c.edge_gain_m == 0 || c.edge_zone_m > 4 * std::abs(c.edge_gain_m)), "edge_zone_m", c.edge_zone_m,
          "more than 4 times edge_gain_m, or the edge would fold");
  require(c.sigma_nonaffine_m >= 0, "sigma_nonaffine_m", c.sigma_nonaffine_m, ">= 0");
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (!(mass[i] > 0) || !std::isfinite(mass[i]))
      throw WorkError("press: the bed has " + std::to_string(mass[i]) + " kg/m2 at x " +
                      std::to_string((static_cast<double>(i % static_cast<std::size_t>(grid.nx)) + 0.5) * grid.pitch_m) + " m, y " +
                      std::to_string((static_cast<double>(i / static_cast<std::size_t>(grid.nx)) + 0.5) * grid.pitch_m) +
                      " m; only a full bed can be pressed (a body feeder before the press fills it)");
}

double mean_of(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}
}  // namespace

PressMap compute_press_map(const std::vector<double>& areal_mass, const BedGrid& grid, const PressMapConfig& config, int threads) {
  check(areal_mass, grid, config);
  PressMap map;
  map.grid = grid;
  map.config = config;
  map.areal_mass_kg_m2 = areal_mass;
  const std::size_t nx = static_cast<std::size_t>(grid.nx), n = areal_mass.size();
  const double mean = mean_of(areal_mass);
  std::vector<double> excess(n), pressed_mass(n), s, edge(nx);
  for (std::size_t i = 0; i < n; ++i) excess[i] = areal_mass[i] / mean - 1;
  for (std::size_t i = 0; i < nx; ++i) {
    const double x0 = static_cast<double>(i) * grid.pitch_m;
    edge[i] = 1 + (edge_shift(map, x0 + grid.pitch_m) - edge_shift(map, x0)) / grid.pitch_m;
  }
  // l_p is a multiple of the gap and the gap (weakly) depends on l_p.
  map.gap_m = mean / pressed_density(config.peak_pressure_pa, config.density_a_kg_m3, config.density_b_kg_m3);
  map.area_ratio.resize(n);
  bool settled = false;
  for (int round = 0; round < kGapRounds && !settled; ++round) {
    map.lateral_length_m = config.lateral_length_factor * std::max(0.0, map.gap_m);
    s = even_out(excess, grid, map.lateral_length_m, threads);
    for (std::size_t i = 0; i < n; ++i) {
      map.area_ratio[i] = (1 + excess[i] - s[i]) * edge[i % nx];  // 1 + div u: the Laplacian's own value, no second discretisation
      if (!(map.area_ratio[i] > kSmallestAreaRatio))
        throw WorkError("press: the bed's mass varies so steeply (" + std::to_string(areal_mass[i]) + " of " + std::to_string(mean) +
                        " kg/m2 in one column) that the powder would fold over itself; level the bed before the press");
      pressed_mass[i] = areal_mass[i] / map.area_ratio[i];
    }
    const double gap = common_gap(pressed_mass, map.area_ratio, config.peak_pressure_pa, config.density_a_kg_m3, config.density_b_kg_m3);
    settled = std::abs(gap - map.gap_m) <= kGapSettled * gap || config.lateral_length_factor == 0;
    map.gap_m = gap;
  }
  if (!settled) throw WorkError("press: gap and lateral flow did not settle within " + std::to_string(kGapRounds) + " rounds");

  map.thickness_m.assign(n, map.gap_m);
  map.density_kg_m3.resize(n);
  map.pressure_pa.resize(n);
  map.lateral_x_m.resize(n);
  map.lateral_y_m.resize(n);
  std::size_t low = 0;
  const double l2 = map.lateral_length_m * map.lateral_length_m / (2 * grid.pitch_m);
  const std::size_t ny = static_cast<std::size_t>(grid.ny);
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x) {
      const std::size_t i = y * nx + x;
      map.density_kg_m3[i] = pressed_mass[i] / map.gap_m;
      map.pressure_pa[i] = pressure_of_density(map.density_kg_m3[i], config.density_a_kg_m3, config.density_b_kg_m3);
      low += map.pressure_pa[i] < 1e6;
      map.lateral_x_m[i] = -l2 * (s[y * nx + std::min(x + 1, nx - 1)] - s[y * nx + (x == 0 ? 0 : x - 1)]);
      map.lateral_y_m[i] = -l2 * (s[(y + 1) % ny * nx + x] - s[(y + ny - 1) % ny * nx + x]);
    }
  map.share_below_1_mpa = static_cast<double>(low) / static_cast<double>(n);
  return map;
}
}  // namespace venato::line
