#pragma once
#include <string>

#include "dem/fields/field_recorder.h"
namespace venato::dem {
/// Density, vertical stress and temperature against the width of the kernel, each over its value at the width in use: flat = a continuum there.
std::string plateau_svg(const std::string& title, const PlateauScan& scan, double width_m);
/// Vertical stress and pressure against height, means over x and y of the cells that hold grains.
std::string stress_profile_svg(const std::string& title, const ContinuumFields& fields);
}  // namespace venato::dem
