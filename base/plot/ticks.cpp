#include "base/plot/ticks.h"

#include <cmath>
#include <cstdio>

#include "base/expects.h"

namespace venato {
namespace {
std::string label_of(double value, double step) {
  char text[40];
  const double magnitude = std::abs(value);
  if (value != 0 && (magnitude >= 1e6 || magnitude < 1e-4)) {
    std::snprintf(text, sizeof text, "%.6g", value);
  } else {
    const int decimals = static_cast<int>(std::fmax(0, -std::floor(std::log10(step) + 1e-9)));
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
  }
  return text;
}
}  // namespace

Ticks round_ticks(double low, double high, int wanted) {
  VENATO_EXPECTS(std::isfinite(low) && std::isfinite(high) && low < high && wanted >= 1);
  const double raw = (high - low) / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double factor = raw / power;
  const double step = power * (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10);
  Ticks ticks;
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  // Beyond 2^53 steps from zero neighbouring ticks are the same double: an axis without ticks beats an endless loop.
  constexpr double kResolvable = 9e15;
  if (!(std::abs(first) < kResolvable && std::abs(last) < kResolvable)) return ticks;
  for (double k = first; k <= last; k += 1) {
    const double value = k == 0 ? 0 : k * step;
    ticks.values.push_back(value);
    ticks.labels.push_back(label_of(value, step));
  }
  return ticks;
}
}  // namespace venato
