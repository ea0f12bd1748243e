#include <algorithm>
#include <cmath>

#include "dem/picture/picture.h"

namespace venato::dem {

Rgb powder_colour(int species) {
  // Okabe & Ito (2008), the neutral tones first: the usual job is a white body with a grey vein.
  static constexpr Rgb kCycle[] = {{222, 214, 200}, {86, 86, 92},  {213, 94, 0},    {0, 114, 178},
                                   {240, 228, 66},  {0, 158, 115}, {204, 121, 167}, {86, 180, 233}};
  constexpr int n = static_cast<int>(std::size(kCycle));
  return kCycle[((species % n) + n) % n];
}

Rgb scale_colour(double v) {
  // Five nodes of viridis (van der Walt & Smith 2015), linear in between.
  static constexpr Rgb kNodes[] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
  const double x = std::clamp(std::isnan(v) ? 0.0 : v, 0.0, 1.0) * (std::size(kNodes) - 1);
  const auto k = std::min(static_cast<std::size_t>(x), std::size(kNodes) - 2);
  const double f = x - static_cast<double>(k);
  Rgb out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(std::lround((1 - f) * kNodes[k][c] + f * kNodes[k + 1][c]));
  return out;
}
}  // namespace venato::dem
