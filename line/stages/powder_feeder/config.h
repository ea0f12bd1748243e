#pragma once
#include "base/config/object_reader.h"
#include "line/slice/slice_case.h"
namespace venato::line::powder_feeder {

/// K hoppers (one powder each) in a row along the belt, each with a sliding actuator (gate) under its outlet, above one common bin that funnels the
/// streams to its throat over the belt. Origin: middle of the throat, z = 0 at the powder level of the bin, where a grain counts as landed.
struct Config {
  double nominal_delay_s = 0;
  double outlet_m = 0, hopper_width_m = 0, hopper_angle_rad = 0, hopper_height_m = 0, gate_travel_time_s = 0, spacing_m = 0;
  double drop_m = 0, throat_m = 0, throat_height_m = 0, funnel_angle_rad = 0, target_m = 0;
  double cycle_s = 0, on_share = 0, settle_s = 0;
  int cycles = 0;
  double dosing_pitch_m = 0, tick_s = 0;  ///< resolution at which the body actuators are told what to do
  SliceNumerics numerics;
};
void read(ObjectReader& r, Config& c);
}  // namespace venato::line::powder_feeder
