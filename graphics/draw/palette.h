#pragma once
#include "graphics/colour/srgb.h"
namespace venato::graphics {

/// viridis: dark blue to yellow, even in lightness, readable for the colour-blind. diverging: blue - light grey - red, for signed quantities.
enum class Palette { viridis, diverging, grey };
/// \param t in [0, 1], clamped; NaN gives white
Srgb8 palette_colour(Palette palette, double t);
}  // namespace venato::graphics
