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
  std::vector<NearGrain> grain;      ///< [place + padding]
  std::vector<std::int32_t> place;  ///< [slot]; empty where every slot is its own place
  float length[3] = {0, 0, 0}, inverse_length[3] = {0, 0, 0};
};

/// \param spheres, reach [slot] \param slots [place] of the search; empty where every place is its own slot
NearField make_near_field(std::span<const Sphere> spheres, std::span<const double> reach, std::span<const std::int32_t> slots,
                          const PeriodicBox& box, int threads);

/// Places of the runs that lie within reach of the grain at place i, itself left out. \param out room for all of the runs and 16 more
/// \return their number
std::size_t near_scan(const NearField& field, std::int32_t i, const std::vector<std::pair<std::int32_t, std::int32_t>>& runs, std::int32_t* out);
}  // namespace venato::dem
