#include "line/products/bed.h"

#include "base/expects.h"
#include "line/products/feed_commands.h"

namespace venato::line {
namespace {
// Row by row: keeps the rounding error of 1e8 additions near 1e-14 without a compensated sum.
double sum_by_rows(const std::vector<double>& values, std::size_t row) {
  double total = 0;
  for (std::size_t begin = 0; begin < values.size(); begin += row) {
    double part = 0;
    for (std::size_t i = begin; i < begin + row; ++i) part += values[i];
    total += part;
  }
  return total;
}
}  // namespace

double Bed::powder_mass_kg(std::size_t powder) const {
  VENATO_EXPECTS(powder < mass.size() && grid.nx > 0);
  return sum_by_rows(mass[powder], static_cast<std::size_t>(grid.nx)) * grid.pitch_m * grid.pitch_m;
}

double Bed::total_mass_kg() const {
  double total = 0;
  for (std::size_t k = 0; k < mass.size(); ++k) total += powder_mass_kg(k);
  return total;
}

std::vector<double> Bed::areal_mass() const {
  std::vector<double> sum(grid.columns(), 0.0);
  for (const auto& powder : mass)
    for (std::size_t i = 0; i < powder.size(); ++i) sum[i % sum.size()] += powder[i];
  return sum;
}

Bed make_bed(const BedGrid& grid, std::vector<std::string> powders) {
  VENATO_EXPECTS(grid.nx > 0 && grid.ny > 0 && grid.nz > 0 && grid.pitch_m > 0);
  Bed bed{grid, std::move(powders), {}};
  bed.mass.assign(bed.powders.size(), std::vector<double>(grid.columns() * static_cast<std::size_t>(grid.nz), 0.0));
  return bed;
}

double FeedHead::mass_kg() const {
  VENATO_EXPECTS(prongs > 0);
  return sum_by_rows(duty, static_cast<std::size_t>(prongs)) * full_rate_kg_m2 * prong_pitch_m * belt_speed_m_s * tick_s;
}
}  // namespace venato::line
