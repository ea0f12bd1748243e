#pragma once
#include <vector>
#include "line/products/bed.h"
namespace venato::line {

/// Composition of a pressed bed at any belt point and depth.
class ColumnSampler {
 public:
  explicit ColumnSampler(const Bed& bed);
  /// Fractions of all powders (sum 1) where the share `mass_above` of the column's mass lies nearer to the face. Linear between the middles of the
  /// layers. \return false where the bed is empty
  bool sample(double belt_x_m, double belt_y_m, double mass_above, double* fractions) const;

 private:
  struct Corner {
    std::size_t column;
    double weight;
  };
  double layer(const Corner* corners, std::size_t z, double* powders) const;  // masses of the powders in layer z; returns their sum
  const Bed& bed_;
  std::vector<double> areal_mass_;
};
}  // namespace venato::line
