#pragma once
#include <array>
#include <cstdint>
namespace venato::sync {
using Rgb = std::array<std::uint8_t, 3>;
// Sky blue and orange of Okabe and Ito's palette (jfly.uni-koeln.de/color): told apart with every kind of colour blindness.
inline constexpr Rgb kBodyColour{86, 180, 233}, kPrintColour{230, 159, 0}, kBothColour{45, 45, 50}, kGroundColour{247, 245, 240};
inline constexpr Rgb kUnmatchedColour{214, 39, 160}, kFaintVein{205, 205, 205}, kInk{30, 30, 30}, kPaper{255, 255, 255};
/// Viridis at t in [0, 1], linear between nine of its samples. Source: matplotlib _cm_listed.py (CC0).
Rgb viridis(double t);
}  // namespace venato::sync
