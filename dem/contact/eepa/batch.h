#pragma once
#include "dem/contact/eepa/law.h"
#include "dem/contact/kernels/pair_batch.h"

namespace venato::dem {
/// Eepa for every lane; b.parameter holds the members of Eepa in order.
void evaluate_batch(const Eepa*, PairBatch& b, int lanes, double dt);
}  // namespace venato::dem
