#pragma once
/// Steady fields of a stationary DEM window on a (y, z) grid: solid fraction, mean velocity, diffusivity tensor (multiscale.md 1.4). The slice is
/// translation-invariant across the belt (x), so x is averaged out; d_xx is the diffusivity across.
#include <span>
#include <vector>
#include "dem/snapshot.h"
namespace venato::dem {

struct FieldGrid {
  double y0_m = 0, z0_m = 0, cell_m = 0;  ///< cells [y0 + i*cell, y0 + (i+1)*cell) x [z0 + j*cell, …); cell about one mean diameter
  int ny = 0, nz = 0;
  std::size_t size() const { return static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz); }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * static_cast<std::size_t>(ny) + static_cast<std::size_t>(i); }
};
struct WindowFields {
  FieldGrid grid;
  std::vector<double> solid_fraction, velocity_y_m_s,
      velocity_z_m_s;  ///< [j][i]; velocity is mass-weighted, midpoint-binned from one-frame displacements
  std::vector<double> d_xx_m2_s, d_yy_m2_s, d_zz_m2_s, d_yz_m2_s;  ///< already divided by cg^2 (design.md 7)
  std::vector<double> samples;                                     ///< grain-frames seen per cell; cells under `min_samples` are masked (fraction 0)
  double lag_s = 0;                                                ///< tau_D used: smallest lag within 5 % of the plateau
  double coarse_graining = 1;
};
struct FieldOptions {
  double slice_width_m = 0;  ///< box length across the belt
  double coarse_graining = 1;
  double min_samples = 50;
  double max_lag_s = 0.25;
  bool periodic_y = false;            ///< the grid spans one period of y (its ny * cell is the box length): positions are wrapped into it
  double lag_s = 0;                   ///< > 0: use this lag instead of choosing one (bootstrap replicates use the lag of the mean)
  std::vector<double> frame_weights;  ///< bootstrap: one weight per frame (empty = all 1); a displacement gets the weight of its first frame
};
/// \param frames at least 3, in rising order of time, ids sorted (as run_case gives them); grains may come and go.
/// Averages over grains are weighted with volume (what is transported is powder mass); d_* = <xi xi'> / (2 tau), xi = displacement over tau minus the
/// mean flow integrated along the grain's own path, put in the cell of the path's midpoint. The lag is chosen once for the whole grid: the smallest
/// whose mean trace is within 5 % of the mean over lags in [max/2, max].
/// \throws UsageError for too few frames, a bad grid, options that do not fit.
WindowFields estimate_fields(std::span<const Snapshot> frames, const FieldGrid& grid, const FieldOptions& options);

/// Window gate of multiscale.md 1.5: halves compared. ok() = velocity change < max(5 %, 3 standard errors), kinetic energy and bed height drift < 2 %
/// … figures returned for the report.
struct StationarityReport {
  double velocity_change, velocity_change_sigmas, kinetic_energy_drift, height_drift;
  bool ok;
};
/// \throws UsageError for fewer than 9 frames.
StationarityReport check_stationarity(std::span<const Snapshot> frames, const FieldGrid& grid, bool periodic_y = false);
}  // namespace venato::dem
