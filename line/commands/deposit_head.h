#pragma once
#include "line/products/bed.h"
#include "line/products/feed_commands.h"
namespace venato::line {
/// Lays what a head is told, without any delay or blur, on the bed: duty x rate x cell area, spread over the grid cells by exact overlap area and
/// evenly over the mass layers. Adds to what is there. Mass is that of head.mass_kg() to rounding. \throws UsageError when the bed does not know the
/// head's powder.
void deposit_head(const FeedHead& head, Bed& bed);
}  // namespace venato::line
