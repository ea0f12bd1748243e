#pragma once
#include "line/stages/belt_transport/config.h"
namespace venato::line::belt_transport {

/// Counters: 0 "inlet" (downwards through the bin, below the feed), 1 "read" (where the bed is read on the next belt), 2 "outlet" (end of the slice,
/// removed). Snapshots: one plan, the stationary window.
dem::Case make_case(const Config& c, const LineBasics& basics);
Operator characterise(const Config& c, const LineBasics& basics, const std::filesystem::path& checkpoint_folder, Context& context);

/// Where the bin is entered, where the bed is read on the next belt (at full height), and where the slice ends.
double inlet_z_m(const Config& c, const LineBasics& basics);
double read_y_m(const Config& c);
double outlet_y_m(const Config& c);
}  // namespace venato::line::belt_transport
