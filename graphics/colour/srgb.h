#pragma once
#include <array>
#include <cstdint>
namespace venato::graphics {
using Srgb8 = std::array<std::uint8_t, 3>;
struct Lab {
  double l = 0, a = 0, b = 0;
};

/// One sRGB sample [0, 255] -> linear light [0, 1]; table of exact values. Source: IEC 61966-2-1.
double srgb_to_linear(std::uint8_t v);
/// Any real linear value (clamped to [0, 1]) -> nearest sRGB sample.
std::uint8_t linear_to_srgb(double linear);
/// The curve itself on [0, 1], unrounded.
double srgb_encode(double linear);

/// CIE L*a*b* for D65, 2 degrees (the sRGB white point; no adaptation). L* in [0, 100].
Lab lab_from_srgb(const Srgb8& c);
/// CIEDE2000 colour difference, kL = kC = kH = 1. Source: Sharma, Wu, Dalal, Color Res. Appl. 30 (2005) 21; tests hold its data.
double delta_e2000(const Lab& x, const Lab& y);
}  // namespace venato::graphics
