#pragma once
#include <span>
#include <vector>
#include "dem/fields/mean_flow.h"
namespace venato::dem {

/// Sums of xi xi' / (2 tau) over stretches of one lag, per cell of the path's midpoint; not divided by cg^2.
struct DiffusivitySums {
  std::vector<double> weight, xx, yy, zz, yz;  ///< per cell; weight = sum of volume * frame weight
  double mean_trace() const;                   ///< [m^2/s] of all stretches together: (xx + yy + zz) / weight / 3
};
DiffusivitySums diffusivity_sums(const Tracks& tracks, const IntegratedFlow& flow, std::span<const double> times_s,
                                 std::span<const double> frame_weights, const MeanFlow& mean, const FieldGrid& grid, bool periodic_y,
                                 std::size_t lag_frames);

/// Lags to try, in frames: 1, 2, 3, 4, 6, 8, 12, 16, … up to max_lag_frames.
std::vector<std::size_t> candidate_lags(std::size_t max_lag_frames);
/// Index of the smallest lag whose trace is within 5 % of the plateau (mean over lags >= half of the largest).
std::size_t smallest_plateau_lag(std::span<const std::size_t> lags, std::span<const double> traces);
}  // namespace venato::dem
