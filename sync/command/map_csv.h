#pragma once
#include <string>
#include "graphics/raster/raster.h"
#include "sync/transform/transform.h"
namespace venato::sync {
/// map.csv: print_from_green on a grid of `step_m` over the vein map, both ends of which the grid holds only if they are multiples:
/// x_green_mm,y_green_mm,x_graphic_mm,y_graphic_mm,sigma_mm; origin at the top-left corner, x right, y down, row by row.
/// \param sigma_m  predicted error of the map, any pitch, interpolated bilinearly; "nan" where it has none
std::string map_csv_text(const Transform& print_from_green, const graphics::RasterF& sigma_m, double width_m, double height_m, double step_m = 0.010);
}  // namespace venato::sync
