#pragma once
#include "line/stages/press/config.h"
namespace venato::line::press {

/// Floor, lid, periodic in x and y. Walls: 0 floor, 1 lid. Snapshots: plan 0 one frame before the lid moves, plan 1 one frame at its end.
dem::Case make_case(const Config& c, const LineBasics& basics);

/// Scatter of grains about the mean pressing displacement (which may depend on height), in the plane.
struct NonAffine {
  double sd_x_m, sd_y_m, strain;
};
NonAffine non_affine_scatter(const dem::Snapshot& before, const dem::Snapshot& after, int height_bins);

Operator characterise(const Config& c, const LineBasics& basics, const std::filesystem::path& checkpoint_folder, Context& context);
}  // namespace venato::line::press
