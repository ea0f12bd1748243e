#pragma once
#include <cstdint>
#include <vector>
#include "base/vec3.h"
namespace venato::dem {

struct Snapshot {                ///< all grains alive, sorted by id; periodic directions unwrapped
  double time_s;
  std::vector<std::int64_t> id;
  std::vector<Vec3> position_m;
  std::vector<Vec3> velocity_m_s;
  std::vector<float> radius_m;
  std::vector<std::int32_t> species;
};
}  // namespace venato::dem
