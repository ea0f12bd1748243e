#pragma once
#include <vector>
#include "base/config/object_reader.h"
#include "line/slice/slice_case.h"
namespace venato::line::piezo_discharge {

/// One hopper over one row of vibrating prongs, one prong pitch wide, periodic across the belt (the seed paper's figure 6).
/// Section (y downstream, z up; origin where the hopper's rear wall meets the prong): powder stands in a vertical hopper of length `outlet_m`, rests
/// on the prong (a plate) and is held back by its own angle of repose; the vibrating prong conveys it under the front wall (gap `gap_m`) and over its
/// lip, `plate_m` further downstream, from where it falls `fall_m` on the belt.
struct Config {
  double prong_pitch_m = 0, tick_s = 0, min_on_s = 0, nominal_delay_s = 0;
  int rows_in_series = 0;
  double frequency_hz = 0, amplitude_m = 0, angle_rad = 0;
  double outlet_m = 0, gap_m = 0, plate_m = 0, hopper_height_m = 0, fall_m = 0;
  SliceNumerics numerics;
  int pulses = 0;
  double min_on_pulse_s = 0, max_on_pulse_s = 0, settle_s = 0;
  std::vector<double> drive_levels;  ///< fractions of the amplitude at which the steady flow is measured as well
};
void read(ObjectReader& r, Config& c);
}  // namespace venato::line::piezo_discharge
