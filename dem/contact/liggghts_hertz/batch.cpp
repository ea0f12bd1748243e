#include "dem/contact/liggghts_hertz/batch.h"

namespace venato::dem {
__attribute__((target_clones("avx512f", "avx2", "default"))) void evaluate_batch(const LiggghtsHertz*, PairBatch& b, int lanes, double dt) {
  evaluate_lanes<LiggghtsHertz>(
      b, lanes, dt, [](const PairBatch& x, int l) __attribute__((always_inline)) {
        return LiggghtsHertz{x.parameter[0][l], x.parameter[1][l], x.parameter[2][l], x.parameter[3][l], x.parameter[4][l], x.parameter[5][l]};
      });
}
}  // namespace venato::dem
