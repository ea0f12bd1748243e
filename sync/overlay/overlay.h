#pragma once
#include <string>
#include <vector>
#include "graphics/raster/raster.h"
#include "sync/score/score.h"
#include "sync/score/visibility.h"
namespace venato::sync {

/// Body veins sky blue, print veins orange, where both lie dark; on the body's off-white. One RGB pixel per mask pixel, nothing written on it
/// (the report's slider lays two of these over each other).
/// \param body, print  0/255, same size, green frame; an empty print shows the body alone
graphics::Raster8 overlay_panel(const graphics::Raster8& body, const graphics::Raster8& print);

struct OverlayTexts {
  std::string left_title = "before synchronisation", right_title = "after synchronisation";
  std::string body_label = "body vein", print_label = "print vein", both_label = "both";
  std::string note;  ///< one line under the picture, ASCII
};
/// The two panels side by side with mm axes, scale bar and legend. An empty `after` leaves the right panel out.
graphics::Raster8 overlay_figure(const graphics::Raster8& body, const graphics::Raster8& before, const graphics::Raster8& after,
                                 const OverlayTexts& texts);

/// Print centre lines coloured by |distance| to the body's, 0 to limit_m (colour bar in mm; more than the limit takes the last colour), samples
/// without partner in magenta, over the body veins in grey.
graphics::Raster8 misfit_figure(const graphics::Raster8& body, const std::vector<ResidualSample>& samples, double limit_m = 0.005,
                                const std::string& title = "distance of print centre line to body vein");

/// The maps of `seen` side by side, one per viewing distance, 0 to limit (colour bar; more takes the last colour). Shrunk pictures show the largest
/// difference of each of their pixels: thin misfits stay visible.
graphics::Raster8 visibility_figure(const std::vector<Visibility>& seen, double limit_delta_e = 10);
}  // namespace venato::sync
