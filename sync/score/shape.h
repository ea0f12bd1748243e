#pragma once
/// Shape of veins beside their place: how wide, how soft at the edge, which way they run (registration_print.md 2.1, domain.md 6).
#include <utility>
#include <vector>
#include "sync/score/centreline.h"
namespace venato::sync {

/// Smallest value at or below which the share q (0..1) of the total weight lies. \param value_weight weights >= 0 \return NaN for an empty list
double weighted_quantile(std::vector<std::pair<double, double>> value_weight, double q);

/// Median of the local vein width over the centre-line length [m]; NaN without links.
double median_width_m(const std::vector<CentreLink>& links);

/// Mean of cos 2(direction of body vein - direction of print vein) over the pixels that both cover, weighted by the product of both structure tensors'
/// coherence ((l1 - l2) / (l1 + l2)). 1 = parallel, 0 = unrelated or 45 deg apart, -1 = crossing at right angles.
/// \param body, print 0/255 masks of the same size and pitch \return NaN where they share no pixel with a direction
/// Derivatives at 1 mm, tensors averaged with a Gaussian of 3 mm (vein widths of 2 to 10 mm keep a direction up to their middle).
double direction_coherence(const graphics::Raster8& body, const graphics::Raster8& print);

/// 10-90 % width of vein edges: for each side of each centre link, along the normal, from where the fraction last falls below 90 % of the value on the
/// centre line to where it first falls below 10 % of it. Edges that rise again (a neighbouring vein) or do not end within reach_m are not counted.
struct EdgeWidths {
  double median_m = 0, p95_m = 0;  ///< by length; NaN when no edge could be measured
  double measured = 0;             ///< 0..1 share of the edge length that could be
};
/// \param fraction vein fraction 0..1, one channel; NaN pixels end an edge uncounted \param links its centre lines (same pitch)
/// Reads up to 3 % long on oblique veins: one link's direction follows the stair of the raster. An ideal edge (step between pixels) reads 0.8 px: the raster's own limit.
EdgeWidths edge_widths(const graphics::RasterF& fraction, const std::vector<CentreLink>& links, double reach_m = 0.030);
}  // namespace venato::sync
