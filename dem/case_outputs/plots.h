#pragma once
#include <optional>
#include <string>
#include <utility>
#include "dem/case_outputs/case_outputs.h"
namespace venato::dem {
/// SVG texts.
std::string counter_mass_svg(const Case& c, const CaseResult& r);
std::string flow_rate_svg(const Case& c, const CaseResult& r);
std::string kinetic_energy_svg(const Case& c, const CaseResult& r);

/// Means over x and y of one snapshot window against height, from estimate_fields on a grid over the box with cells of one largest grain.
struct HeightProfile {
  std::vector<double> z_mm, velocity_y_mm_s, velocity_z_mm_s, solid_fraction;  ///< velocities NaN where nothing moved through
};
/// None with fewer than 3 frames or no grains.
std::optional<HeightProfile> height_profile(const Case& c, const std::vector<Snapshot>& frames);
std::string velocity_profile_svg(const Case& c, const HeightProfile& p);
std::string solid_fraction_profile_svg(const Case& c, const HeightProfile& p);
}  // namespace venato::dem
