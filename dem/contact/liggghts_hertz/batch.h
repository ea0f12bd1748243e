#pragma once
#include "dem/contact/kernels/pair_batch.h"
#include "dem/contact/liggghts_hertz/law.h"

namespace venato::dem {
/// LiggghtsHertz for every lane; b.parameter holds the members of LiggghtsHertz in order.
void evaluate_batch(const LiggghtsHertz*, PairBatch& b, int lanes, double dt);
}  // namespace venato::dem
