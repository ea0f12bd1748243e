#include "dem/psd/check_sizes.h"

#include <cmath>
#include <cstdio>

#include "base/error.h"

namespace venato::dem {
namespace {
constexpr double kUm = 1e6;  // [um/m] messages are in the unit that users type

std::string um(double metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g um", metres * kUm);
  return text;
}
}  // namespace

std::string size_distribution_problem(const SizeDistribution& psd) {
  const bool monodisperse = psd.lower_cut_m == psd.upper_cut_m;
  if (!(psd.lower_cut_m > 0) || !std::isfinite(psd.lower_cut_m))
    return "the lower cut is " + um(psd.lower_cut_m) + ", it must be > 0: the number of grains per mass diverges without it (for shape <= 3)";
  if (!(psd.upper_cut_m >= psd.lower_cut_m) || !std::isfinite(psd.upper_cut_m))
    return "the upper cut is " + um(psd.upper_cut_m) + ", it must be finite and >= the lower cut " + um(psd.lower_cut_m);
  if (monodisperse) return "";  // scale and shape do not matter then
  if (!(psd.scale_m > 0) || !std::isfinite(psd.scale_m)) return "the scale is " + um(psd.scale_m) + ", it must be > 0";
  if (!(psd.shape > 0) || !std::isfinite(psd.shape)) return "the shape is " + std::to_string(psd.shape) + ", it must be > 0";
  return "";
}

void require_sizes(const SizeDistribution& psd, std::string_view name) {
  const std::string problem = size_distribution_problem(psd);
  if (!problem.empty()) throw UsageError(std::string(name) + ": " + problem);
}
}  // namespace venato::dem
