#include "graphics/raster/weighted_sum.h"
namespace venato::graphics {

__attribute__((target_clones("avx2", "default"))) void weighted_sum(const float* const* rows, const float* w, int taps, int n, float* out) {
  for (int i = 0; i < n; i += kSumLanes) {
    float sum[kSumLanes] = {};
    for (int k = 0; k < taps; ++k)
      for (int l = 0; l < kSumLanes; ++l) sum[l] += w[k] * rows[k][i + l];
    for (int l = 0; l < kSumLanes; ++l) out[i + l] = sum[l];
  }
}
}  // namespace venato::graphics
