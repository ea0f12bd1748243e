#pragma once
#include "dem/contact/eepa/law.h"
#include "dem/contact/kernels/pair_batch.h"

namespace venato::dem {
/// Eepa for every lane; b.parameter holds the members of Eepa in order. Here and below: for the CPU at hand, same bytes on all.
void evaluate_batch(const Eepa*, PairBatch& b, int lanes, double dt);
/// law.force() for one contact.
ContactForce force_of(const Eepa& law, const ContactGeometry& g, ContactHistory& h, double dt);
}  // namespace venato::dem
