#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "dem/case.h"
#include "dem/run_case.h"
#include "line/stages/stage_api.h"
namespace venato::line {

/// Numerical settings of a slice, the same keys in every stage.
struct SliceNumerics {
  double coarse_graining = 4;    ///< grain diameter factor (verification.md 7)
  double slice_width_m = 0.006;  ///< periodic length across the belt
  double expected_max_speed_m_s = 1.5;
};
void read_slice_numerics(ObjectReader& r, SliceNumerics& n, double default_coarse_graining, double default_width_mm, double default_max_speed_m_s);

/// Empty periodic slice (x across the belt is periodic) with the line's materials and, as species, the listed powders.
dem::Case make_slice_case(const LineBasics& basics, std::string_view name, const SliceNumerics& numerics, const std::vector<int>& powders,
                          double y_low_m, double y_high_m, double z_low_m, double z_high_m);

using Profile = std::vector<std::pair<double, double>>;  ///< (y, z) [m]
/// Adds a wall made of a profile extruded across the slice. Returns its index in c.walls.
std::size_t add_profile_wall(dem::Case& c, std::string name, const Profile& yz_m, int material, const dem::WallMotion& motion = {},
                             const dem::Interval& present = {});

/// Runs the case; an interrupted run leaves `checkpoint` and continues from it, bit for bit, the next time.
dem::CaseResult run_slice(const dem::Case& c, const std::filesystem::path& checkpoint, Context& context);

/// Cost of a slice that is fed under level control: it holds about as many grains as it starts with, however many pass through.
dem::CaseCost estimate_slice_cost(const dem::Case& c, int threads);

/// Warns where coarse grains are too coarse for a gap, by the rule of dem/coarse_graining/openings.h.
void warn_if_too_coarse(const LineBasics& basics, int powder, const SliceNumerics& numerics, std::string_view what, double opening_m,
                        std::vector<std::string>& warnings);

/// Largest, smallest and mean (by number) coarse-grained grain diameter of a powder [m].
double largest_grain_m(const LineBasics& basics, double coarse_graining);
double smallest_grain_m(const LineBasics& basics, double coarse_graining);
double mean_grain_m(const LineBasics& basics, int powder, double coarse_graining);
}  // namespace venato::line
