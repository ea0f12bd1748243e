#include "dem/rigs/support/statistics.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "base/expects.h"

namespace venato::dem::rigs {
namespace {
const double kNan = std::numeric_limits<double>::quiet_NaN();
}

Estimate mean_of(std::span<const double> values) {
  double n = 0, sum = 0;
  for (const double v : values)
    if (std::isfinite(v)) n += 1, sum += v;
  if (n == 0) return {kNan, kNan};
  const double mean = sum / n;
  double squares = 0;
  for (const double v : values)
    if (std::isfinite(v)) squares += (v - mean) * (v - mean);
  return {mean, n > 1 ? std::sqrt(squares / (n - 1) / n) : kNan};
}

LineFit fit_line(std::span<const double> x, std::span<const double> y, std::span<const double> weights, bool inverse_variances) {
  VENATO_EXPECTS(x.size() == y.size() && (weights.empty() || weights.size() == x.size()));
  const auto weight = [&](std::size_t k) { return weights.empty() ? 1.0 : weights[k]; };
  double w = 0, mx = 0, my = 0;
  for (std::size_t k = 0; k < x.size(); ++k) w += weight(k), mx += weight(k) * x[k], my += weight(k) * y[k];
  LineFit fit{kNan, kNan, kNan, kNan, kNan, kNan, kNan};
  if (!(w > 0)) return fit;
  mx /= w, my /= w;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += weight(k) * (x[k] - mx) * (x[k] - mx);
    xy += weight(k) * (x[k] - mx) * (y[k] - my);
    yy += weight(k) * (y[k] - my) * (y[k] - my);
  }
  if (!(xx > 0)) return fit;
  fit.slope = xy / xx;
  fit.intercept = my - fit.slope * mx;
  double residual = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double e = y[k] - fit.intercept - fit.slope * x[k];
    residual += weight(k) * e * e;
  }
  fit.rms = std::sqrt(residual / w);
  fit.r2 = yy > 0 ? 1 - residual / yy : 1;
  // Variance of one observation of weight 1.
  const double unit = inverse_variances ? 1 : x.size() > 2 ? residual / static_cast<double>(x.size() - 2) : kNan;
  fit.slope_error = std::sqrt(unit / xx);
  fit.intercept_error = std::sqrt(unit * (1 / w + mx * mx / xx));
  fit.covariance = -unit * mx / xx;
  return fit;
}

std::string short_number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}
}  // namespace venato::dem::rigs
