#pragma once
/// What the simulation itself knows about where powder went: the yardstick ("best reachable") for a registration that only sees pictures.
#include <vector>
#include "line/chain/run_chain.h"
#include "sync/transform/transform.h"
namespace venato::line {

/// Mean displacement of vein powder along the belt between its command and the bed in front of the press, per mass layer [m], positive downstream,
/// belt jitter not included. Measured with the line's own operators: one tick of all vein prongs is switched on and the centroid of its powder is
/// read in every layer. Exact for the linear chain (colour is passive), whatever delays the stages take off. NaN for layers that receive none of it.
std::vector<double> layer_shifts(const LineConfig& config, const LineBasics& basics, const std::vector<Operator>& operators,
                                 const FeedCommands& commands, Context& context);

/// The exact counterpart of a registration: green -> belt (press, cut) -> undo the jitter -> undo the layer's mean shift -> design -> print (trial
/// placement included).
struct ExactMap {
  const LineConfig* config = nullptr;
  const graphics::RasterF* belt_from_green_m = nullptr;  ///< of the slab
  JitterField jitter;
  double shift_y_m = 0;  ///< mean shift of the layer that is looked at
  sync::Transform placement;
  sync::Point operator()(sync::Point green_m) const;  ///< print frame
};
ExactMap make_exact_map(const LineConfig& config, const Slab& slab, const JitterField& jitter, const std::vector<double>& shifts, double zeta);

/// Print vein mask as it would be seen on the slab with the exact map: 255 where the print's vein fraction is above the threshold. Green frame.
graphics::Raster8 exact_mask_on_green(const graphics::RasterF& print_fraction, const ExactMap& map, int width, int height, double pitch_m,
                                      float threshold);

/// Distance between a transform and the exact map over the vein pixels of `mask` [m]: median and 95th percentile. NaN without veins.
struct MapError {
  double median_m, p95_m;
};
MapError compare_with_exact(const sync::Transform& print_from_green, const ExactMap& map, const graphics::Raster8& mask);

/// Value of a raster channel at a point of its frame, bilinear between pixel centres, border value outside.
double sample_bilinear(const graphics::RasterF& raster, double x_m, double y_m, int channel);
}  // namespace venato::line
