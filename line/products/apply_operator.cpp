#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/expects.h"
#include "line/products/kernel_on_bed.h"
#include "line/products/operator.h"
#include "line/products/spectral_convolution.h"

namespace venato::line {
namespace {
// Transforms leave noise of about 1e-16 of the largest value where nothing landed; below this share of it a cell is empty.
constexpr double kNoiseShare = 1e-14;

void check_layers(const Operator& op, const Bed& bed, int needed_layers) {
  const bool alike = op.nz_in == 1 && op.nz_out == 1;
  if (!alike && needed_layers != bed.grid.nz)
    throw UsageError("operator '" + op.stage + "' works on " + std::to_string(needed_layers) + " mass layers, the bed has " +
                     std::to_string(bed.grid.nz) + "; use the same number of layers for both");
  for (const auto& powder : bed.mass) VENATO_EXPECTS(powder.size() == bed.grid.columns() * static_cast<std::size_t>(bed.grid.nz));
}

struct Content {
  double sum = 0, largest = 0;
  bool non_negative = true;
};
Content content_of(const std::vector<double>& mass, std::size_t row) {
  Content c;
  for (std::size_t begin = 0; begin < mass.size(); begin += row) {
    double part = 0;
    for (std::size_t i = begin; i < begin + row; ++i) {
      part += mass[i];
      c.largest = std::max(c.largest, mass[i]);
      c.non_negative = c.non_negative && mass[i] >= 0;
    }
    c.sum += part;
  }
  return c;
}

// Empties the cells that hold only rounding noise and puts the powder's mass back to what it was, by one factor within about 1e-13 of 1.
void remove_noise(std::vector<double>& mass, std::size_t row, const Content& before) {
  const double floor = kNoiseShare * before.largest;
  double sum = 0;
  for (std::size_t begin = 0; begin < mass.size(); begin += row) {
    double part = 0;
    for (std::size_t i = begin; i < begin + row; ++i) {
      if (mass[i] < floor) mass[i] = 0;
      part += mass[i];
    }
    sum += part;
  }
  if (sum <= 0) return;
  const double factor = before.sum / sum;
  for (double& m : mass) m *= factor;
}
}  // namespace

Bed apply(const Operator& op, const Bed& bed, double belt_speed_m_s, double nominal_delay_s, int threads, int replicate) {
  check_layers(op, bed, op.nz_in);
  const bool best = replicate < 0;
  const auto r = static_cast<std::size_t>(std::max(0, replicate));
  if (!best && (r >= op.replicates.size() || r >= op.replicate_reference_delay_s.size()))
    throw UsageError("operator '" + op.stage + "' has " + std::to_string(op.replicates.size()) + " bootstrap replicates, number " +
                     std::to_string(replicate) + " was asked for");
  const BedKernel kernel = kernel_on_bed(op, best ? op.weight : op.replicates[r], best ? op.reference_delay_s : op.replicate_reference_delay_s[r],
                                         bed.grid.pitch_m, belt_speed_m_s, nominal_delay_s);
  const std::size_t row = static_cast<std::size_t>(bed.grid.nx);
  std::vector<Content> before;
  for (const auto& powder : bed.mass) before.push_back(content_of(powder, row));
  Bed out = bed;
  convolve_in_place(out, kernel, threads);
  // Signed input (differences of beds) stays as computed: there is no sign to restore.
  for (std::size_t k = 0; k < out.mass.size(); ++k)
    if (before[k].non_negative) remove_noise(out.mass[k], row, before[k]);
  return out;
}

Bed apply_transposed(const Operator& op, const Bed& bed, double belt_speed_m_s, double nominal_delay_s, int threads) {
  check_layers(op, bed, op.nz_out);
  const BedKernel kernel = kernel_on_bed(op, op.weight, op.reference_delay_s, bed.grid.pitch_m, belt_speed_m_s, nominal_delay_s);
  Bed out = bed;
  convolve_in_place(out, transposed(kernel), threads);
  return out;
}
}  // namespace venato::line
