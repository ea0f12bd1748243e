#pragma once
#include <string_view>
namespace venato {
/// SI value of one `unit` as used in config ranges: "mm" -> 1e-3, "um", "m", "s", "ms", "m/s", "m/min", "kg/m3", "g/cm3",
/// "kg/m2", "MPa", "Pa", "GPa", "Hz", "deg" (-> rad), "%" (-> 0.01), "g/s", "g", "dpi" (-> 1: stays dots per inch), "rpm" (-> rad/s), "" and "1" ->
/// 1, … The list is in units.cpp; add to it what a declaration needs. \throws std::logic_error for an unknown unit (a programmer error: units come
/// from declarations, never from users).
double si_factor(std::string_view unit);
inline constexpr double kMetresPerInch = 0.0254;
inline constexpr double kStandardGravity_m_s2 = 9.80665;
}  // namespace venato
