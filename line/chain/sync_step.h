#pragma once
/// Registration of the graphic to the simulated slab, and the three scores.
#include "line/chain/exact_map.h"
#include "line/chain/pictures.h"
#include "line/chain/slab_view.h"
#include "sync/registration/registration.h"
#include "sync/score/score.h"
#include "sync/score/shape.h"
#include "sync/score/visibility.h"
#include "sync/score/zones.h"
namespace venato::line {

struct SyncResult {
  sync::Registration registration;
  sync::Transform nominal;                                        ///< print_from_green of the file as designed: first corners together, drying only
  graphics::RasterF print_fraction;                               ///< vein fraction of the graphic, print frame
  graphics::Raster8 body, print_before, print_after, print_best;  ///< vein masks, green frame, 0/255
  sync::Metrics before, best;
  std::optional<sync::SlabScore> zones;              ///< of `after`
  std::optional<sync::Metrics> after;                ///< none when the registration failed: then the print stays as designed
  sync::EdgeWidths body_edge, print_edge;            ///< 10-90 % edge widths of the predicted body veins and of the graphic's
  std::optional<sync::VisibilityReport> visibility;  ///< none for a graphic without veins
  std::vector<sync::ResidualSample> residuals_before, residuals_after, residuals_best;
  MapError error_before{}, error_after{};  ///< against the simulation's own displacement, over the body's vein pixels
};
SyncResult synchronise(const LineConfig& config, const graphics::VeinMap& vein_map, const std::vector<LoadedLayer>& layers, const ExactMap& exact,
                       Context& context);

/// The same map for a slab seen `scale` times smaller (dried): print_from_dried(p) = print_from_green(p / scale).
sync::Transform on_dried_slab(const sync::Transform& print_from_green, double scale);
}  // namespace venato::line
