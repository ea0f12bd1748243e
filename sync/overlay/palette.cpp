#include "sync/overlay/palette.h"

#include <algorithm>
#include <cmath>

namespace venato::sync {
Rgb viridis(double t) {
  constexpr std::array<Rgb, 9> samples = {
      {{68, 1, 84}, {71, 44, 122}, {59, 81, 139}, {44, 113, 142}, {33, 144, 141}, {39, 173, 129}, {92, 200, 99}, {170, 220, 50}, {253, 231, 37}}};
  const double s = std::clamp(t, 0.0, 1.0) * 8;
  const auto k = std::min<std::size_t>(static_cast<std::size_t>(s), 7);
  const double f = s - static_cast<double>(k);
  Rgb out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(std::lround(samples[k][c] * (1 - f) + samples[k + 1][c] * f));
  return out;
}
}  // namespace venato::sync
