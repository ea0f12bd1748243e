#pragma once
/// When coarse grains are too large for a case: openings and layers against the coarse grain.
///
/// The rule. d' = coarse_graining times the diameter of the mean grain volume. Openings: below 6 d' flow is not reliable at all (outside Beverloo's
/// range, arches); above, it must be within 10 % of that of the real grains by Beverloo's law (at coarse_graining 2 and a hole: from about 18 d' on,
/// at 4 from 26 d'). Layers: below 10 d' a layer's surface and floor make up too much of it.
/// Source: Beverloo 1961 with k = 1.4; Roessler & Katterfeld 2018 for layers.
#include <string>
#include <string_view>
#include <vector>
#include "dem/case.h"
namespace venato::dem {

inline constexpr double kFewestGrainsPerOpening = 6, kFewestGrainsPerLayer = 10;
inline constexpr double kAcceptedFlowFactor = 0.9;
inline constexpr double kBeverlooEmptyAnnulus = 1.4;  ///< k

/// Diameter of the mean grain volume (by number) of one powder times the coarse graining [m]; of a case: the largest of its powders'.
double mean_volume_grain_m(const SizeDistribution& psd, double coarse_graining);
double mean_volume_grain_m(const Case& c);

/// Flow with coarse grains over flow with the real ones by Beverloo: ((D - k cg d) / (D - k d))^2.5 for a hole, ^1.5 for a slot.
/// \param grain_m  real mean grain d, \return 0 when the coarse grains do not pass at all (D <= k cg d), NaN when the real ones do not either.
double coarse_flow_factor(double opening_m, double grain_m, double coarse_graining, bool slot);

/// Coarse graining at which coarse_flow_factor() is `factor` (< 1): what to use for an error of 1 - factor.
double coarse_graining_for(double factor, double opening_m, double grain_m, bool slot);

/// Warning text for one opening, with numbers; empty when there is nothing to say.
std::string opening_warning(std::string_view name, double opening_m, bool slot, double grain_m, double coarse_graining);
std::string layer_warning(double thickness_m, double grain_m, double coarse_graining);
/// Of everything the case states: openings (its own and its rig's) and layer thickness.
std::vector<std::string> coarse_graining_warnings(const Case& c);
}  // namespace venato::dem
