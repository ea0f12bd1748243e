#pragma once
/// First, coarse search of neighbours, in single precision and several candidates at a time. Finds everything that is near and a little more; the
/// exact test follows (pair_list.cpp), so the rounding here decides nothing.
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dem/neighbours/cell_grid.h"

namespace venato::dem {

/// Place from a common origin and reach, the reach made larger by what rounding may take.
struct NearGrain {
  float x, y, z, reach;
};

struct NearField {
  std::vector<NearGrain> grain;  ///< [slot + padding]
  float length[3] = {0, 0, 0}, inverse_length[3] = {0, 0, 0};
};

/// \param reach [slot]
NearField make_near_field(std::span<const Sphere> spheres, std::span<const double> reach, const PeriodicBox& box, int threads);

/// Slots of the runs that lie within reach of grain i, itself left out. \param out room for all of the runs and 16 more \return their number
std::size_t near_scan(const NearField& field, std::int32_t i, const std::vector<std::pair<std::int32_t, std::int32_t>>& runs, std::int32_t* out);
}  // namespace venato::dem
