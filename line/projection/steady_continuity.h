#pragma once
#include "line/projection/open_stage.h"
namespace venato::line {

struct ContinuityReport {
  double defect_before = 0, defect_after = 0;  ///< rms over cells of the net outflow of the face fluxes, relative to the inlet flux
  double velocity_change = 0;                  ///< rms change of velocity / rms velocity over the corrected cells
  double outlet_scale = 1;                     ///< what the outlet's flux had to be multiplied by
};

/// u <- u - grad psi with div(phi grad psi) = div(phi u) (multiscale.md eq. 1.2) on the cells that the inlet can reach without crossing inlet or
/// outlet. Fluxes through faces to unknown cells and the border are zero; those through the two segments stay as measured, the outlet's scaled to the
/// inlet's. Finite volumes, sparse Cholesky. \throws WorkError when the inlet's region has no outlet.
ContinuityReport enforce_steady_continuity(dem::WindowFields& fields, const Segment& inlet, const Segment& outlet);
}  // namespace venato::line
