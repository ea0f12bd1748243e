#pragma once
#include "line/press_map/press_map.h"
namespace venato::line {
/// Outward shift of the strip by its edges [m] at belt x (negative at the left edge): edge_gain at the wall, fading quadratically over edge_zone.
double edge_shift(const PressMap& map, double x_m);
/// Lateral plus edge displacement at a belt point, before springback: bilinear, its x part odd about the side walls (no flow through them), periodic
/// along the belt.
PlanePoint displacement_at(const PressMap& map, PlanePoint belt);
}  // namespace venato::line
