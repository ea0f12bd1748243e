#include "line/stages/belt_transport/slice.h"

#include <algorithm>
#include <cmath>

namespace venato::line::belt_transport {
namespace {
constexpr double kFeedBand_m = 0.012;
constexpr double kReadAt = 0.4;           // of the run on the next belt: the bed ends in a free slope about as long as it is high
constexpr double kLoose = 1.5;            // freshly laid fills settle to about 1 / 1.5 of their height
constexpr double kClearance_m = 0.0003;   // walls above a moving belt: less than any grain
constexpr double kBeltOverlap_m = 0.012;  // the next belt begins this far upstream of the end of the first
}  // namespace

double inlet_z_m(const Config& c, const LineBasics& basics) { return c.level_m - 2 * largest_grain_m(basics, c.numerics.coarse_graining); }
double read_y_m(const Config& c) { return c.run_m + kReadAt * c.next_run_m; }
double outlet_y_m(const Config& c) { return c.run_m + c.next_run_m; }

dem::Case make_case(const Config& c, const LineBasics& basics) {
  const double v = basics.belt_speed_m_s, width = c.numerics.slice_width_m;
  const double top = kLoose * c.level_m + kFeedBand_m, end = outlet_y_m(c);
  dem::Case s = make_slice_case(basics, "belt_transport window", c.numerics, {basics.body_powder}, -c.bin_m - 0.004, end + 0.012, -c.drop_m - 0.006,
                                top + 0.006);
  s.duration_s = c.settle_s + c.window_s;
  dem::WallMotion belt;
  belt.surface_velocity_m_s = Vec3(0, v, 0);
  add_profile_wall(s, "belt", {{-c.bin_m - 0.003, 0}, {c.run_m, 0}}, LineBasics::kBelt, belt);
  add_profile_wall(s, "next belt", {{c.run_m - kBeltOverlap_m, -c.drop_m}, {end + 0.012, -c.drop_m}}, LineBasics::kBelt, belt);
  add_profile_wall(s, "bin rear", {{-c.bin_m, top}, {-c.bin_m, kClearance_m}}, LineBasics::kSteel);
  add_profile_wall(s, "levelling gate", {{0, top}, {0, c.gate_m}}, LineBasics::kSteel);

  // Start close to the stationary state: bin full, bed already on both belts and moving with them.
  auto fill = [&](double y0, double y1, double z0, double z1, double speed) {
    dem::Fill f;
    f.low = Vec3(0, y0, z0);
    f.high = Vec3(width, y1, z1);
    f.powder_mass_fractions = {1.0};
    f.velocity_m_s = Vec3(0, speed, 0);
    s.fills.push_back(f);
  };
  fill(-c.bin_m, 0, 0.0005, kLoose * c.level_m, 0);
  fill(0.0005, c.run_m, 0.0005, kLoose * c.gate_m, v);
  fill(c.run_m + 0.001, end, -c.drop_m + 0.0005, -c.drop_m + kLoose * c.gate_m, v);
  dem::Rain rain;
  rain.name = "bin feed";
  rain.low = Vec3(0, -c.bin_m, c.level_m + 0.004);
  rain.high = Vec3(width, 0, c.level_m + 0.004 + kFeedBand_m);
  rain.powder_mass_fractions = {1.0};
  rain.mass_rate_kg_s = 1.6 * basics.bed_mass_kg_m2 * v * width;  // the level control sets the rate
  rain.level_z_m = c.level_m;
  rain.resting_speed_m_s = std::max(rain.resting_speed_m_s, 2 * v * c.gate_m / c.bin_m);  // twice the speed at which the bin sinks
  rain.velocity_m_s = Vec3(0, 0, -0.6);
  s.rains.push_back(rain);

  dem::Counter inlet;
  inlet.name = "inlet";
  inlet.axis = 2;
  inlet.position_m = inlet_z_m(c, basics);
  inlet.sign = -1;
  inlet.window_low.y() = -c.bin_m;
  inlet.window_high.y() = 0;
  dem::Counter outlet;
  outlet.name = "outlet";
  outlet.axis = 1;
  outlet.position_m = end;
  outlet.sign = +1;
  outlet.remove = true;
  dem::Counter read = outlet;
  read.name = "read";
  read.position_m = read_y_m(c);
  read.remove = false;
  s.counters = {inlet, read, outlet};
  s.series.every_s = 0.01;
  s.snapshots.push_back({c.settle_s, c.settle_s + c.window_s, c.frame_s});
  return s;
}
}  // namespace venato::line::belt_transport
