#pragma once
#include "base/config/object_reader.h"
#include "line/slice/slice_case.h"
namespace venato::line::belt_transport {

/// Extraction from the common bin by the belt, levelling gate, drop to the next belt; periodic across the belt. Origin: on the belt below the
/// levelling gate. The bin stands on the belt upstream of it (rear wall at y = -bin_m), the bed runs `run_m` on the first belt, falls `drop_m` and
/// runs `next_run_m` on the next belt, where it is measured.
struct Config {
  double nominal_delay_s = 0;
  double bin_m = 0, gate_m = 0, level_m = 0, run_m = 0, drop_m = 0, next_run_m = 0;
  SliceNumerics numerics;
  double settle_s = 0, window_s = 0, frame_s = 0;
  int tracers = 0;
};
void read(ObjectReader& r, Config& c);
}  // namespace venato::line::belt_transport
