#pragma once
#include <vector>
#include "sync/registration/image_ops.h"
namespace venato::sync {

constexpr int kPatchLanes = 8;  ///< block rows are whole multiples: a fixed order of sums on every SIMD width

/// Window around a block with rows of zeros on the right, so that inner loops run over whole lanes.
struct Patch {
  int width = 0, height = 0, stride = 0;
  std::vector<float> value, mask;
  bool all_valid = true;
  double mask_sum = 0;
};
/// \param row_room  row length of the patch, >= width
Patch cut(const Feature& f, int x0, int y0, int width, int height, int row_room);
/// Row length of a window that is searched +-s pixels for a block with rows of `block_stride`.
inline int window_room(int block_stride, int s) { return block_stride + 2 * s + 4; }

/// NCC for all shifts in [-s, s]^2; NaN where too little of the block is valid or the window is flat.
struct Surface {
  int s = 0;
  std::vector<double> v;
  double at(int dx, int dy) const { return v[static_cast<std::size_t>((dy + s) * (2 * s + 1) + dx + s)]; }
};
/// \param block   rows of whole lanes, mean removed (sums stay small and float products exact enough)
/// \param window  s pixels larger on every side, rows of window_room()
/// \param min_valid  share of the block's area that must be valid on both sides
Surface ncc_surface(const Patch& block, const Patch& window, int s, double min_valid, double window_variance_floor);
}  // namespace venato::sync
