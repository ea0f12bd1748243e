#include "dem/contact/hertz_mindlin/batch.h"

namespace venato::dem {
__attribute__((target_clones("avx512f", "avx2", "default"))) void evaluate_batch(const HertzMindlin*, PairBatch& b, int lanes, double dt) {
  evaluate_lanes<HertzMindlin>(
      b, lanes, dt, [](const PairBatch& x, int l) __attribute__((always_inline)) {
        return HertzMindlin{x.parameter[0][l], x.parameter[1][l], x.parameter[2][l], x.parameter[3][l], x.parameter[4][l],
                            x.parameter[5][l], x.parameter[6][l], x.parameter[7][l], x.parameter[8][l]};
      });
}
}  // namespace venato::dem
