#pragma once
#include "dem/contact/hertz_mindlin/law.h"
#include "dem/contact/kernels/pair_batch.h"

namespace venato::dem {
/// HertzMindlin for every lane; b.parameter holds the members of HertzMindlin in order.
void evaluate_batch(const HertzMindlin*, PairBatch& b, int lanes, double dt);
}  // namespace venato::dem
