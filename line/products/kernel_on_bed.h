#pragma once
#include <vector>
#include "line/products/operator.h"
namespace venato::line {

/// A stage kernel resampled onto the cells of a bed: weight of landing dy cells downstream and dx cells to either side.
struct BedKernel {
  int nz_in = 0, nz_out = 0, y_offset = 0, n_y = 0, n_x = 0;
  std::vector<double> weight;  ///< [zin][zout][n_y][n_x]: dy = y_offset + row; column e is the weight of each of dx = +e and dx = -e (e = 0: once)
  const double* pair(int zin, int zout) const {
    return weight.data() + (static_cast<std::size_t>(zin) * static_cast<std::size_t>(nz_out) + static_cast<std::size_t>(zout)) *
                               static_cast<std::size_t>(n_y) * static_cast<std::size_t>(n_x);
  }
};

/// dy = -(reference_delay + theta - nominal_delay) * belt_speed / pitch, dx = eta / pitch, both between cells in general. Each sample is shared
/// between its two neighbour cells in each direction (cloud in cell): mass and mean stay exact, the variance grows by f (1 - f) cells^2 (f the offset
/// inside the cell; h^2/6 on average, h^2/4 at most, per direction). Where the kernel is at least about three cells wide that growth is taken back by
/// `sharpen`; a kernel narrower than that keeps it, which no non-negative kernel with the right mean can avoid. Samples coarser than a cell are
/// spread evenly over their own width first, so that no comb appears (a lone sample is a point, whatever its width). \throws UsageError when the
/// kernel is not symmetric across the belt, does not keep mass, or has a negative weight.
BedKernel kernel_on_bed(const Operator& op, const std::vector<double>& weight, double reference_delay_s, double pitch_m, double belt_speed_m_s,
                        double nominal_delay_s);

/// Time-reversed and with in and out layers swapped: the kernel of the adjoint.
BedKernel transposed(const BedKernel& kernel);

/// Takes `excess` (in cells^2, for unit mass `mass`) of variance out of the lines h[line * line_stride + i * stride], i < n, by moving equal amounts
/// from both neighbours into a cell: mass and mean stay exact, nothing becomes negative. Takes less where the lines are too narrow. \return what is
/// left of the excess
double sharpen(double* h, int lines, std::size_t line_stride, int n, std::size_t stride, double mass, double excess);
}  // namespace venato::line
