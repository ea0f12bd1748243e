#pragma once
#include "dem/contact/hertz_mindlin/law.h"
#include "dem/contact/kernels/pair_batch.h"

namespace venato::dem {
/// HertzMindlin for every lane; b.parameter holds the members of HertzMindlin in order. Here and below: for the CPU at hand, same bytes on all.
void evaluate_batch(const HertzMindlin*, PairBatch& b, int lanes, double dt);
/// law.force() for one contact.
ContactForce force_of(const HertzMindlin& law, const ContactGeometry& g, ContactHistory& h, double dt);
}  // namespace venato::dem
