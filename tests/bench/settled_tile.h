#pragma once
#include "tests/bench/shear_case.h"
#include "tests/bench/start_file.h"

namespace venato::bench {
/// 25,000 grains settled under gravity on a floor at z = 0, periodic in x and y, about 12 mm deep; at rest (rms speed below 1 mm/s).
/// The same bytes for any number of threads. \throws WorkError when the bed does not come to rest.
StartState settled_tile(const std::string& psd, int threads);
}  // namespace venato::bench
