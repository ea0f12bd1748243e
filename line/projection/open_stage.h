#pragma once
#include <cstdint>
#include <limits>
#include <vector>
#include "dem/fields/window_fields.h"
#include "line/products/operator.h"
namespace venato::line {

/// A straight inlet or outlet in the (y, z) plane of the fields. Its first end is zeta = 0 (the bottom, for upright ones).
struct Segment {
  double y0_m, z0_m, y1_m, z1_m;
};

struct ProjectionOptions {
  double grain_diameter_m = std::numeric_limits<double>::quiet_NaN();  ///< mean diameter d of the real powder (not of the coarse grains), > 0
  double max_time_s = std::numeric_limits<double>::quiet_NaN();        ///< a tracer still inside after that is counted as stuck, > 0
  double max_step_s = std::numeric_limits<double>::infinity();
  /// Correct the velocities so that div(phi u) = 0 (multiscale.md eq. 1.2), walls closed, outlet flow scaled to the inlet's.
  bool steady_continuity = false;
  double step_factor = 1;      ///< scales the step rule: convergence studies
  bool with_drift = true;      ///< false only as a negative control
  bool with_diffusion = true;  ///< false: streamlines only (negative control, delay of pure advection)
};

struct TracerRecord {
  double zeta_in, zeta_out;  ///< mass-flux quantiles across inlet and outlet
  double theta_s;            ///< from inlet to outlet
  double eta_m;              ///< across the belt
};
struct ProjectionResult {
  std::vector<TracerRecord> landed;  ///< in order of the tracer number
  int tracers = 0, stuck = 0;        ///< stuck: still inside after max_time_s
  int lost = 0;                      ///< left the known part of the field where no reflection brings them back
  double inlet_flux_m2_s = 0,
         outlet_flux_m2_s = 0;  ///< solid volume per second and width through each, from the field: their difference is its defect of continuity
  double mean_steps = 0;
};

/// Tracers seeded by mass flux on the inlet (stratified), carried by eq. 1.3 through the steady fields until they cross the outlet; unseen cells and
/// the grid's border reflect, so does the inlet from inside. Bits do not depend on `threads`: random numbers are keyed by tracer and step. \throws
/// UsageError (options), WorkError (no flow through inlet or outlet, which then says what the fields hold there)
ProjectionResult project_open_stage(const dem::WindowFields& fields, const Segment& inlet, const Segment& outlet, int n_tracers,
                                    const ProjectionOptions& options, std::uint64_t seed, int threads);

/// Landings of weight 1 on nz_in x nz_out equal mass-flux layers, for operator_from_landings.
std::vector<Landing> landings_of(const ProjectionResult& result, int nz_in, int nz_out);
}  // namespace venato::line
