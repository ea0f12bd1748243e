#pragma once
#include <cstdint>
#include <vector>
#include "line/config/line_config.h"
namespace venato::line {

/// Displacement along the belt between dosing and press, j(y) with y_press = y + j(y): encoder and slip errors. Smooth, zero mean, periodic over the
/// strip; a Gaussian random field with correlation exp(-(d / correlation)^2) and the configured root mean square, drawn from the run's seed.
class JitterField {
 public:
  JitterField() = default;  ///< zero displacement
  JitterField(const BeltJitter& jitter, double strip_length_m, std::uint64_t seed);
  double displacement_m(double y_m) const;
  double slope(double y_m) const;       ///< dj/dy
  double undo(double y_press_m) const;  ///< y with y + j(y) = y_press, to 1e-12 m
  bool is_zero() const { return cosine_.empty(); }

 private:
  double length_m_ = 1;
  std::vector<double> cosine_, sine_;  ///< amplitude of wave k + 1 [m]
};

/// Bed moved by the field: every row's mass is spread over the interval its edges move to. The mass of every powder in every layer is kept to
/// rounding. \throws WorkError when the field folds (slope <= -1).
Bed move_bed(const Bed& bed, const JitterField& field, int threads);
}  // namespace venato::line
