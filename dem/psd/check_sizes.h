#pragma once
#include <string>
#include <string_view>
#include "dem/psd/size_distribution.h"
namespace venato::dem {

/// What is wrong with a size distribution, as a sentence for the user ("" = nothing): scale, shape > 0, lower cut > 0 (the number density
/// ~ d^(shape-4) diverges at 0 for shape <= 3; below that it is still a model parameter that must be chosen), finite upper cut >= lower cut.
std::string size_distribution_problem(const SizeDistribution& psd);

/// \throws UsageError "<name>: <problem>".
void require_sizes(const SizeDistribution& psd, std::string_view name);
}  // namespace venato::dem
