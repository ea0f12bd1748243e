#include "graphics/draw/palette.h"

#include <algorithm>
#include <cmath>
#include <span>
namespace venato::graphics {
namespace {
// Ten even steps of matplotlib's viridis (CC0) and of Moreland's cool-warm map; straight lines between.
constexpr Srgb8 kViridis[] = {{68, 1, 84},    {72, 40, 120},  {62, 74, 137},  {49, 104, 142}, {38, 130, 142},
                              {31, 158, 137}, {53, 183, 121}, {109, 205, 89}, {180, 222, 44}, {253, 231, 37}};
constexpr Srgb8 kDiverging[] = {{59, 76, 192}, {124, 159, 249}, {192, 212, 245}, {230, 230, 230}, {242, 203, 183}, {238, 133, 104}, {180, 4, 38}};
constexpr Srgb8 kGrey[] = {{0, 0, 0}, {255, 255, 255}};
}  // namespace

Srgb8 palette_colour(Palette palette, double t) {
  if (std::isnan(t)) return {255, 255, 255};
  const std::span<const Srgb8> stops = palette == Palette::viridis     ? std::span<const Srgb8>(kViridis)
                                       : palette == Palette::diverging ? std::span<const Srgb8>(kDiverging)
                                                                       : std::span<const Srgb8>(kGrey);
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double u = at - static_cast<double>(k);
  Srgb8 c{};
  for (std::size_t i = 0; i < 3; ++i) c[i] = static_cast<std::uint8_t>(std::lround((1 - u) * stops[k][i] + u * stops[k + 1][i]));
  return c;
}
}  // namespace venato::graphics
