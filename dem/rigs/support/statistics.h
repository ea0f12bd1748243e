#pragma once
/// Small statistics shared by the rigs.
#include <span>
#include <string>
namespace venato::dem::rigs {

struct Estimate {
  double mean, standard_error;  ///< NaN when there is nothing (error: fewer than two values)
};
/// Mean of the finite values and standard error of that mean, sd / sqrt(n) with the n - 1 variance: blocks, wedges, strips taken as independent.
Estimate mean_of(std::span<const double> values);

/// Straight line y = intercept + slope x by least squares; weights may be empty (all 1). `rms` is the weighted rms residual, `r2` the share of the
/// variance explained. All NaN with fewer than two different x. `slope_error`, `intercept_error`: from the weights taken as 1 / sigma^2 when
/// `weights_are_inverse_variances`, else from the residuals (NaN with fewer than three points).
struct LineFit {
  double slope, intercept, rms, r2, slope_error, intercept_error, covariance;  ///< covariance of slope and intercept
};
LineFit fit_line(std::span<const double> x, std::span<const double> y, std::span<const double> weights = {},
                 bool weights_are_inverse_variances = false);

/// "8.5": shortest text of a number that is typed in a config; for names.
std::string short_number(double v);
}  // namespace venato::dem::rigs
