#pragma once
/// The peers: elastix (Debian's program) and OpenCV's findTransformECC as its manual shows it.
#include <functional>
#include <optional>
#include <string>
#include "sync/registration/registration.h"
namespace venato::bench {
struct PeerResult {
  bool ran = false;
  double seconds = 0;
  std::function<sync::Point(sync::Point)> print_from_green;
};
/// B-spline registration by the program `elastix`, started at `pose`: the graphic is resampled into the slab's frame first, so elastix need not
/// search. Timed is the program elastix alone (the field is read by transformix, untimed).
PeerResult run_elastix(const graphics::RasterF& green, const graphics::RasterF& print, const sync::Transform& pose, const std::string& parameters,
                       const std::string& folder, int threads);
/// findTransformECC(MOTION_AFFINE) at 4 mm/px from the nominal place, with its default Gaussian of 5 px.
PeerResult run_plain_ecc(const graphics::RasterF& green, const graphics::RasterF& print, sync::Point nominal_shift_m);
}  // namespace venato::bench
