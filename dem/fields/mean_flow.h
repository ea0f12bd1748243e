#pragma once
#include <span>
#include <vector>
#include "dem/fields/grid_lookup.h"
#include "dem/fields/tracks.h"
namespace venato::dem {

/// Mean flow of a window from midpoint-binned one-frame displacements, volume-weighted, and how to evaluate it inside cells.
struct MeanFlow {
  std::vector<double> u_y_m_s, u_z_m_s;        ///< per cell; 0 where masked
  std::vector<double> y_m, z_m;                ///< mean place of the samples: where that velocity holds
  std::vector<double> samples, weight;         ///< grain-frames (not weighted); sum of volume * frame weight * dt
  std::vector<double> uy_y, uy_z, uz_y, uz_z;  ///< [1/s] gradients from neighbouring sampled cells
  bool known(std::size_t cell) const { return weight[cell] > 0; }
};

/// \param times_s of the frames; \param frame_weights one per frame.
/// Cells with fewer than `min_samples` are masked.
MeanFlow mean_flow(const Tracks& tracks, std::span<const double> times_s, std::span<const double> frame_weights, const FieldGrid& grid,
                   bool periodic_y, double min_samples);

/// Per entry: integral of the mean flow along the path from its first entry on (position - this = fluctuation), and how many frame intervals so
/// far had no known flow (masked cell, outside the grid): a stretch between two entries is usable when both have the same count.
struct IntegratedFlow {
  std::vector<Vec3> displacement_m;
  std::vector<std::int32_t> unknown;
};
IntegratedFlow integrated_flow(const Tracks& tracks, std::span<const double> times_s, const MeanFlow& flow, const FieldGrid& grid, bool periodic_y);
}  // namespace venato::dem
