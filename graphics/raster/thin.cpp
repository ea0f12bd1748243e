#include "graphics/raster/mask.h"
namespace venato::graphics {
namespace {
/// Neighbours in Zhang and Suen's order P2 … P9: N, NE, E, SE, S, SW, W, NW.
constexpr int kDx[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr int kDy[8] = {-1, -1, 0, 1, 1, 1, 0, -1};

unsigned neighbours(const Raster8& m, int i, int j) {
  unsigned bits = 0;
  for (unsigned k = 0; k < 8; ++k) {
    const int x = i + kDx[k], y = j + kDy[k];
    if (x >= 0 && y >= 0 && x < m.width && y < m.height && m.at(x, y)) bits |= 1u << k;
  }
  return bits;
}
/// Neither an end nor a link: the neighbours inside form one arc of 2 to 6.
bool simple(unsigned n) {
  int count = 0, rises = 0;
  for (unsigned k = 0; k < 8; ++k) {
    count += n >> k & 1u;
    rises += !(n >> k & 1u) && (n >> ((k + 1) % 8) & 1u);
  }
  return count >= 2 && count <= 6 && rises == 1;
}
bool removable(unsigned n, int pass) {
  if (!simple(n)) return false;
  const bool north = n & 1u, east = n & 4u, south = n & 16u, west = n & 64u;
  return pass == 0 ? !(north && east && south) && !(east && south && west) : !(north && east && west) && !(north && south && west);
}
}  // namespace

Raster8 thin(const Raster8& mask) {
  VENATO_EXPECTS(mask.channels == 1);
  Raster8 m = mask;
  // Only pixels on an outline can go, so each round looks at the neighbours of what went before.
  std::vector<std::uint32_t> candidates, next, gone;
  for (int j = 0; j < m.height; ++j)
    for (int i = 0; i < m.width; ++i)
      if (m.at(i, j) && neighbours(m, i, j) != 0xffu) candidates.push_back(static_cast<std::uint32_t>(m.index(i, j)));
  Raster8 queued(m.width, m.height, 1, 0);
  int idle = 0;
  for (int pass = 0; idle < 2; pass = 1 - pass) {
    gone.clear();
    for (auto p : candidates)
      if (m.data[p] && removable(neighbours(m, static_cast<int>(p) % m.width, static_cast<int>(p) / m.width), pass)) gone.push_back(p);
    // The paper removes all of them at once, which deletes 2 x 2 blocks and cuts diagonals two pixels wide; asked again one by one, the
    // topology stays.
    std::erase_if(gone, [&](std::uint32_t p) {
      if (!simple(neighbours(m, static_cast<int>(p) % m.width, static_cast<int>(p) / m.width))) return true;
      m.data[p] = 0;
      return false;
    });
    idle = gone.empty() ? idle + 1 : 0;
    next.clear();
    const auto offer = [&](std::uint32_t p) {
      if (m.data[p] && !queued.data[p]) {
        queued.data[p] = 1;
        next.push_back(p);
      }
    };
    for (auto p : candidates) offer(p);
    for (auto p : gone)
      for (unsigned k = 0; k < 8; ++k) {
        const int x = static_cast<int>(p) % m.width + kDx[k], y = static_cast<int>(p) / m.width + kDy[k];
        if (x >= 0 && y >= 0 && x < m.width && y < m.height) offer(static_cast<std::uint32_t>(m.index(x, y)));
      }
    for (auto p : next) queued.data[p] = 0;
    candidates.swap(next);
  }
  for (auto& v : m.data) v = v ? 255 : 0;
  return m;
}
}  // namespace venato::graphics
