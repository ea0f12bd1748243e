#include "line/press_map/press_gap.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/expects.h"

namespace venato::line {
namespace {
constexpr double kMegapascal = 1e6;
constexpr int kMaxNewton = 200;
}  // namespace

double pressed_density(double pressure_pa, double a_kg_m3, double b_kg_m3) { return a_kg_m3 + b_kg_m3 * std::log(pressure_pa / kMegapascal); }
double pressure_of_density(double density_kg_m3, double a_kg_m3, double b_kg_m3) {
  return kMegapascal * std::exp((density_kg_m3 - a_kg_m3) / b_kg_m3);
}

double common_gap(const std::vector<double>& mass_kg_m2, const std::vector<double>& area, double peak_pressure_pa, double a_kg_m3, double b_kg_m3) {
  VENATO_EXPECTS(!mass_kg_m2.empty() && mass_kg_m2.size() == area.size());
  const double target = pressed_density(peak_pressure_pa, a_kg_m3, b_kg_m3);
  if (!(target > 0))
    throw UsageError("press: density law a + b ln P gives " + std::to_string(target) + " kg/m3 at " + std::to_string(peak_pressure_pa / kMegapascal) +
                     " MPa; give the powder's measured density_a_kg_m3 and density_b_kg_m3");
  const double heaviest = *std::max_element(mass_kg_m2.begin(), mass_kg_m2.end());
  // q = 1 / gap. At this start every column has the peak pressure or more: above the root, from where Newton walks down monotonically.
  double lightest = heaviest;
  for (double m : mass_kg_m2) lightest = std::min(lightest, m);
  double q = target / lightest;
  for (int round = 0; round < kMaxNewton; ++round) {
    double sum = 0, slope = 0, total = 0;  // relative to the heaviest column: no overflow
    for (std::size_t i = 0; i < mass_kg_m2.size(); ++i) {
      const double p = area[i] * std::exp((mass_kg_m2[i] - heaviest) * q / b_kg_m3);
      sum += p;
      slope += p * mass_kg_m2[i];
      total += area[i];
    }
    const double value = b_kg_m3 * std::log(sum / total) + heaviest * q - target;
    const double step = value / (slope / sum);
    q -= step;
    if (std::abs(step) <= 1e-15 * q) break;
  }
  if (!(q > 0) || !std::isfinite(q)) throw WorkError("press: no gap gives the peak pressure; the bed's mass differs too much between columns");
  return 1 / q;
}
}  // namespace venato::line
