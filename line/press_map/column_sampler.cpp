#include "line/press_map/column_sampler.h"

#include <algorithm>
#include <array>

#include "base/expects.h"

namespace venato::line {
namespace {
constexpr std::size_t kMaxPowders = 32;
}

ColumnSampler::ColumnSampler(const Bed& bed) : bed_(bed), areal_mass_(bed.areal_mass()) { VENATO_EXPECTS(bed.powders.size() <= kMaxPowders); }

double ColumnSampler::layer(const Corner* corners, std::size_t z, double* powders) const {
  double sum = 0;
  const std::size_t plane = z * bed_.grid.columns();
  for (std::size_t k = 0; k < bed_.mass.size(); ++k) {
    double m = 0;
    for (std::size_t c = 0; c < 4; ++c) m += corners[c].weight * bed_.mass[k][plane + corners[c].column];
    powders[k] = m;
    sum += m;
  }
  return sum;
}

bool ColumnSampler::sample(double belt_x_m, double belt_y_m, double mass_above, double* fractions) const {
  const BedGrid& g = bed_.grid;
  const double a = std::clamp(belt_x_m / g.pitch_m - 0.5, 0.0, g.nx - 1.0), b = std::clamp(belt_y_m / g.pitch_m - 0.5, 0.0, g.ny - 1.0);
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b), nx = static_cast<std::size_t>(g.nx);
  const std::size_t i2 = std::min(i + 1, nx - 1), j2 = std::min(j + 1, static_cast<std::size_t>(g.ny) - 1);
  const double f = a - static_cast<double>(i), h = b - static_cast<double>(j);
  const std::array<Corner, 4> corners{
      {{j * nx + i, (1 - f) * (1 - h)}, {j * nx + i2, f * (1 - h)}, {j2 * nx + i, (1 - f) * h}, {j2 * nx + i2, f * h}}};
  double total = 0;
  for (const Corner& c : corners) total += c.weight * areal_mass_[c.column];
  if (!(total > 0)) return false;

  // Walk from the nearer face until the middle of a layer lies beyond the wanted mass.
  const bool from_top = mass_above <= 0.5;
  const double wanted = (from_top ? mass_above : 1 - mass_above) * total;
  std::array<double, kMaxPowders> here{}, before{};
  double passed = 0, middle_before = 0, mass_before = 0;
  const std::size_t nz = static_cast<std::size_t>(g.nz), powders = bed_.mass.size();
  for (std::size_t step = 0; step < nz; ++step) {
    const double mass = layer(corners.data(), from_top ? nz - 1 - step : step, here.data());
    if (!(mass > 0)) continue;
    const double middle = passed + 0.5 * mass;
    if (middle >= wanted || step + 1 == nz) {
      const double w = mass_before > 0 ? std::clamp((wanted - middle_before) / (middle - middle_before), 0.0, 1.0) : 1;
      for (std::size_t k = 0; k < powders; ++k) fractions[k] = w * here[k] / mass + (mass_before > 0 ? (1 - w) * before[k] / mass_before : 0);
      return true;
    }
    passed += mass;
    middle_before = middle;
    mass_before = mass;
    before = here;
  }
  if (!(mass_before > 0)) return false;
  for (std::size_t k = 0; k < powders; ++k) fractions[k] = before[k] / mass_before;  // only empty layers lay beyond
  return true;
}
}  // namespace venato::line
