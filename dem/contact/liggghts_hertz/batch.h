#pragma once
#include "dem/contact/liggghts_hertz/law.h"
#include "dem/contact/kernels/pair_batch.h"

namespace venato::dem {
/// LiggghtsHertz for every lane; b.parameter holds the members of LiggghtsHertz in order. Here and below: for the CPU at hand, same bytes on all.
void evaluate_batch(const LiggghtsHertz*, PairBatch& b, int lanes, double dt);
/// law.force() for one contact.
ContactForce force_of(const LiggghtsHertz& law, const ContactGeometry& g, ContactHistory& h, double dt);
}  // namespace venato::dem
