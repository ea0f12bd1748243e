#include "base/units.h"

#include <array>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace venato {
namespace {
using Entry = std::pair<std::string_view, double>;
constexpr double kMinute_s = 60, kHour_s = 3600;
constexpr double kDegree_rad = std::numbers::pi / 180;

// Literals are written as the quotient that is exact in decimal (1e-3, not 0.1 * 0.01), so that 5 mm is the double nearest to 0.005 times one
// rounding.
constexpr Entry kUnits[] = {
    // plain numbers and counts
    {"", 1},
    {"1", 1},
    {"-", 1},
    {"%", 1e-2},
    {"ppm", 1e-6},
    {"px", 1},
    {"dpi", 1},
    {"bit", 1},
    {"bits", 1},
    {"count", 1},
    {"steps", 1},
    {"d", 1},
    // length, area, volume
    {"m", 1},
    {"cm", 1e-2},
    {"mm", 1e-3},
    {"um", 1e-6},
    {"nm", 1e-9},
    {"in", kMetresPerInch},
    {"m2", 1},
    {"cm2", 1e-4},
    {"mm2", 1e-6},
    {"m3", 1},
    {"cm3", 1e-6},
    {"mm3", 1e-9},
    {"l", 1e-3},
    {"1/m", 1},
    {"1/mm", 1e3},
    {"1/m2", 1},
    {"1/m3", 1},
    {"mm/m", 1e-3},
    {"um/m", 1e-6},
    {"px/mm", 1e3},
    {"mm/px", 1e-3},
    // time, rates
    {"s", 1},
    {"ms", 1e-3},
    {"us", 1e-6},
    {"ns", 1e-9},
    {"min", kMinute_s},
    {"h", kHour_s},
    {"Hz", 1},
    {"kHz", 1e3},
    {"1/s", 1},
    {"1/min", 1 / kMinute_s},
    {"1/h", 1 / kHour_s},
    {"%/s", 1e-2},
    // motion
    {"m/s", 1},
    {"cm/s", 1e-2},
    {"mm/s", 1e-3},
    {"um/s", 1e-6},
    {"m/min", 1 / kMinute_s},
    {"mm/min", 1e-3 / kMinute_s},
    {"m/s2", 1},
    {"mm/s2", 1e-3},
    {"m2/s", 1},
    {"mm2/s", 1e-6},
    {"m3/s", 1},
    {"deg", kDegree_rad},
    {"rad", 1},
    {"mrad", 1e-3},
    {"rad/s", 1},
    {"deg/s", kDegree_rad},
    {"rpm", 2 * std::numbers::pi / kMinute_s},
    // mass
    {"kg", 1},
    {"g", 1e-3},
    {"mg", 1e-6},
    {"ug", 1e-9},
    {"t", 1e3},
    {"kg/s", 1},
    {"g/s", 1e-3},
    {"mg/s", 1e-6},
    {"kg/min", 1 / kMinute_s},
    {"kg/h", 1 / kHour_s},
    {"g/min", 1e-3 / kMinute_s},
    {"t/h", 1e3 / kHour_s},
    {"kg/m3", 1},
    {"g/cm3", 1e3},
    {"g/l", 1},
    {"kg/m2", 1},
    {"g/m2", 1e-3},
    {"g/cm2", 10},
    {"kg/m2/s", 1},
    {"kg/m", 1},
    {"g/m", 1e-3},
    // force, pressure, energy
    {"N", 1},
    {"mN", 1e-3},
    {"uN", 1e-6},
    {"kN", 1e3},
    {"N/m", 1},
    {"N/mm", 1e3},
    {"kN/m", 1e3},
    {"Pa", 1},
    {"kPa", 1e3},
    {"MPa", 1e6},
    {"GPa", 1e9},
    {"bar", 1e5},
    {"mbar", 1e2},
    {"MPa/s", 1e6},
    {"1/MPa", 1e-6},
    {"1/Pa", 1},
    {"J", 1},
    {"mJ", 1e-3},
    {"J/m2", 1},
    {"mJ/m2", 1e-3},
    {"Pa.s", 1},
    {"mPa.s", 1e-3},
    {"W", 1},
    {"V", 1},
    {"K", 1},
    // computer
    {"B", 1},
    {"KiB", 1024.},
    {"MiB", 1048576.},
    {"GiB", 1073741824.},
};
}  // namespace

double si_factor(std::string_view unit) {
  for (const auto& [name, factor] : kUnits)
    if (name == unit) return factor;
  throw std::logic_error("si_factor: unknown unit '" + std::string(unit) + "'; add it to base/units.cpp");
}
}  // namespace venato
