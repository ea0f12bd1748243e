#pragma once
#include <limits>
#include <vector>
#include "line/products/bed.h"
#include "line/products/slab.h"
namespace venato::line {

/// What the press does, closed form (multiscale.md 3.3). NaN = forgotten: compute_press_map refuses it.
struct PressMapConfig {
  double peak_pressure_pa = std::numeric_limits<double>::quiet_NaN();       ///< mean over the strip, > 0
  double density_a_kg_m3 = std::numeric_limits<double>::quiet_NaN();        ///< rho = a + b ln(P / MPa), moist pressed density; user data
  double density_b_kg_m3 = std::numeric_limits<double>::quiet_NaN();        ///< > 0
  double lateral_length_factor = std::numeric_limits<double>::quiet_NaN();  ///< c: powder evens out over l_p = c * gap, >= 0
  double springback = std::numeric_limits<double>::quiet_NaN();             ///< in plane, fraction: x -> x (1 + s)
  double edge_gain_m = 0,
         edge_zone_m = 0;        ///< the strip's edge moves out by edge_gain at each side wall, fading quadratically over edge_zone (machine-set)
  double sigma_nonaffine_m = 0;  ///< blur of the granules' rearrangement, from the DEM slice
};

/// The strip after the press, per belt column [y][x] (material columns: what lay at that belt point).
/// thickness * density * area_ratio = areal_mass in every column, to rounding.
struct PressMap {
  BedGrid grid;
  PressMapConfig config;
  double gap_m = 0;              ///< h1, common to all columns; chosen so that the mean pressure over the pressed area is the peak pressure
  double lateral_length_m = 0;   ///< l_p
  double share_below_1_mpa = 0;  ///< columns pressed at less than 1 MPa, where rho = a + b ln P does not hold
  std::vector<double> areal_mass_kg_m2, thickness_m, pressure_pa, density_kg_m3;
  std::vector<double> area_ratio;                ///< pressed area / belt area, springback not included
  std::vector<double> lateral_x_m, lateral_y_m;  ///< displacement by mass gradients at column centres; springback and edge gain not included
};

/// u = -l_p^2 grad s with (1 - l_p^2 lap) s = m / mean(m) - 1, no flow through the side walls, periodic along the belt: for patterns wider than l_p
/// this is u = -l_p^2 grad(dm / m) of multiscale.md; for narrower ones, where that would fold, the excess just evens out (mass after flow is mean *
/// (1 + s) to first order). Then P = exp((m / (h1 area_ratio) - a) / b) MPa. \param areal_mass [ny][nx] kg/m2, all > 0 \throws UsageError for a
/// config or a bed without meaning (message names the value); WorkError where the mass differences are so steep that the map would fold.
PressMap compute_press_map(const std::vector<double>& areal_mass_kg_m2, const BedGrid& grid, const PressMapConfig& config, int threads = 1);

struct PlanePoint {
  double x_m, y_m;
};
/// Pressed (strip after springback, same origin and axes as the belt) from belt, and back by fixed point to 1e-9 m.
PlanePoint pressed_from_belt(const PressMap& map, PlanePoint belt);
PlanePoint belt_from_pressed(const PressMap& map, PlanePoint pressed);

/// Where the slab is cut out of the pressed strip: first corner, then x axis turned by `rotation_rad` (counter-clockwise with y downstream being
/// clockwise on a picture).
struct CutWindow {
  double x_m = 0, y_m = 0, rotation_rad = 0, width_m = 0, length_m = 0;
};
/// Cut, and everything sampled at the green pixel centres (bilinear). The bed is moved into the slab. Density is per green area: the strip's density
/// / (1 + springback)^2, so that density * thickness * green area is the mass; thickness is the gap (springback in thickness is not modelled).
/// Positions are kept as float: 0.25 um at 4 m.
/// \throws UsageError when the window reaches outside the strip.
Slab make_slab(Bed bed, const PressMap& map, const CutWindow& cut, double green_pitch_m, int threads = 1);
}  // namespace venato::line
