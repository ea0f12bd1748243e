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

/// CIE 1931 XYZ of linear sRGB; the white, D65, has Y = 1 (X 0.9505, Z 1.0888).
struct Xyz {
  double x = 0, y = 0, z = 0;
};
/// \param r, g, b linear light, any real value. Source: IEC 61966-2-1 primaries.
Xyz xyz_from_linear(double r, double g, double b);
Xyz xyz_from_srgb(const Srgb8& c);
/// White = xyz_from_linear(1, 1, 1), exactly, so that neutral greys have a* = b* = 0. Values outside of the gamut, negative ones too, follow CIE 15's
/// own continuation (the line below (6/29)^3).
Lab lab_from_xyz(const Xyz& c);
/// Its inverse.
Xyz xyz_from_lab(const Lab& c);

/// CIE L*a*b* for D65, 2 degrees (the sRGB white point; no adaptation). L* in [0, 100].
Lab lab_from_srgb(const Srgb8& c);
/// CIEDE2000 colour difference, kL = kC = kH = 1. Source: Sharma, Wu, Dalal, Color Res. Appl. 30 (2005) 21; tests hold its data.
double delta_e2000(const Lab& x, const Lab& y);
}  // namespace venato::graphics
