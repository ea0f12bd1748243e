#include "line/products/sinkhorn.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace venato::line {
namespace {
constexpr int kRounds = 100000;
constexpr double kTolerance = 1e-12;
}  // namespace

double balance_layers(const std::string& stage, int nz, const std::vector<double>& pair_mass, std::vector<double>& weight) {
  const std::size_t n = static_cast<std::size_t>(nz), patch = weight.size() / (n * n);
  std::vector<double> rows(n, 1.0), columns(n, 1.0);
  double defect = 1;
  for (int round = 0; round < kRounds && defect > kTolerance; ++round) {
    for (std::size_t j = 0; j < n; ++j) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += rows[i] * pair_mass[i * n + j];
      if (!(sum > 0))
        throw WorkError("stage '" + stage + "': nothing arrives in output layer " + std::to_string(j) + ", a full bed cannot have that");
      columns[j] = 1 / sum;
    }
    defect = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < n; ++j) sum += pair_mass[i * n + j] * columns[j];
      defect = std::max(defect, std::abs(rows[i] * sum - 1));
      rows[i] = 1 / sum;
    }
  }
  if (!(defect <= kTolerance))
    throw WorkError("stage '" + stage + "': the layer exchange cannot be made mass-conserving (residual " + std::to_string(defect) +
                    "); the projected tracers do not fill the bed evenly");
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double factor = rows[i] * columns[j];
      if (pair_mass[i * n + j] > 0) largest = std::max(largest, std::abs(factor - 1));
      for (std::size_t k = (i * n + j) * patch; k < (i * n + j + 1) * patch; ++k) weight[k] *= factor;
    }
  return largest;
}
}  // namespace venato::line
