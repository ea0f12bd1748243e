#pragma once
/// Looking at the pressed slab: face or polished depth, cuts, error bars.
#include "graphics/vein_map/vein_map.h"
#include "line/chain/run_chain.h"
namespace venato::line {

/// Size of the cut slab in the green frame.
struct SlabSize {
  double width_m, length_m;
};
SlabSize green_size(const LineBasics& basics);

/// Mass quantile (0 bottom, 1 face) that lies `depth_m` below the pressed face of a slab of this thickness, for uniform density.
double zeta_at_depth(double depth_m, double thickness_m);

/// Fractions of all powders on a plane `depth_m` below the pressed face, on the slab's own pixels.
graphics::VeinMap look_at_slab(const LineBasics& basics, const Slab& slab, double depth_m, int threads);

/// Standard error of the vein fraction from the operators' bootstrap replicates: every replicate goes through the whole chain on a coarser bed. One
/// channel at the coarse pitch, green frame; empty when the operators carry fewer than 2 replicates.
graphics::RasterF vein_standard_error(const LineConfig& config, const std::vector<Operator>& operators, const FeedCommands& commands,
                                      const JitterField& jitter, Context& context);
/// The same raster on another grid (bilinear).
graphics::RasterF resample_to(const graphics::RasterF& raster, int width, int height, double pitch_m);

/// Shift along the belt that best lays the veins of the face onto those of the bottom face (normalised correlation, within 150 mm, NaN beyond) [m]; positive: the
/// bottom lies downstream. NaN without veins.
double top_bottom_offset(const LineBasics& basics, const Slab& slab, int threads);
}  // namespace venato::line
