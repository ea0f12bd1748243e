#pragma once
#include <string>
#include <vector>
#include "base/context.h"
#include "sync/registration/block_match.h"
#include "sync/registration/phase_clock.h"
#include "sync/registration/spline_fit.h"
namespace venato::sync {

struct NonrigidResult {
  Transform map;
  bool folded = false;  ///< still folding after lambda was doubled three times
  JacobianRange jacobian;
  std::vector<BlockMatch> blocks;             ///< of the last pass, relative to the map they were measured with
  std::vector<Observation> observations;      ///< the same blocks as total displacements
  std::vector<bool> held_out;                 ///< every 5th block: not used by `map_without_held_out`
  BSplineField held_out_field;                ///< fitted without the held-out blocks
  int textured = 0;                           ///< blocks of the last pass that ought to have matched
  double blur_print_m = 0, blur_green_m = 0;  ///< extra smoothing of the last level that made both sides equally sharp
  BlockSettings last_level;
  double lambda = 0;           ///< of the last fit
  std::vector<double> weight;  ///< robust weight of each observation in the last fit
  BSplineField reference;      ///< the prior field on the last level's grid
};
/// Four levels of block matching and robust spline fits (registration_print.md 1.3 step 3), starting from `start` and bending towards its field.
/// Slabs whose shorter side is below 0.6 m get blocks and control points scaled down with it.
/// \param green, print  signed evidence at 1 mm (already of one polarity)
NonrigidResult fit_nonrigid(const Feature& green, const Feature& print, const Transform& start, Context& context, PhaseClock& clock);
}  // namespace venato::sync
