#pragma once
#include "base/config/object_reader.h"
#include "line/slice/slice_case.h"
namespace venato::line::press {

/// Column-wise compaction by the closed-form map; a cohesive DEM slice (EEPA) between floor and lid, periodic in the plane, gives the non-affine
/// scatter.
struct Config {
  double peak_pressure_pa = 0, density_a_kg_m3 = 0, density_b_kg_m3 = 0;
  double lateral_length_factor = 0, springback = 0, edge_gain_m = 0, edge_zone_m = 0;
  SliceNumerics numerics;
  double stiffness_ratio = 0, adhesion_ratio = 0;
  double bed_height_m = 0, lid_speed_m_s = 0, end_solid_fraction = 0, settle_s = 0;
};
void read(ObjectReader& r, Config& c);
}  // namespace venato::line::press
