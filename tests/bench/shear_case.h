#pragma once
/// The benchmark's cases (tests/bench/cases.txt) and the powder they share.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dem/psd/size_distribution.h"
#include "dem/simulation/simulation.h"

namespace venato::bench {

struct ShearCase {
  std::string name, psd;  ///< psd: "mono" or "poly"
  int tiles_x = 0, tiles_y = 0;
  double time_step_s = 0;
  double floor_m_s = 0;  ///< speed of the floor's surface along x; 0 = bed at rest
  std::int64_t warmup_steps = 0, window_steps = 0;
};

constexpr int kWindows = 3;
constexpr std::size_t kTileGrains = 25'000;
constexpr double kGravity = 9.81;  ///< [m/s2] the peers' value, not standard gravity

/// \throws UsageError naming the line that is not a case.
std::vector<ShearCase> read_cases(const std::filesystem::path& file);
/// \throws UsageError listing the known names.
ShearCase find_case(const std::vector<ShearCase>& cases, const std::string& name);

/// rho 2000 kg/m3, E 10 MPa, nu 0.25, e 0.4, friction 0.5, EPSD rolling friction 0.1 with damping ratio 0.3; grains and floor alike.
dem::MaterialTable bench_materials();
/// mono: 380 um. poly: Weibull by mass, scale 380 um, shape 2.7, cut to 200 .. 700 um.
dem::SizeDistribution bench_sizes(const std::string& psd);
}  // namespace venato::bench
