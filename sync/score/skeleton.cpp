#include <array>
#include <vector>
#include "base/expects.h"
#include "sync/score/distance.h"
#include "sync/score/score.h"
namespace venato::sync {
namespace {
// P2..P9 of the paper: north, then clockwise.
std::array<std::ptrdiff_t, 8> neighbours(int w) { return {-w, -w + 1, 1, w + 1, w, w - 1, -1, -w - 1}; }
}  // namespace

/// Source: T. Y. Zhang & C. Y. Suen, Comm. ACM 27 (1984) 236. Pixels beyond the image count as empty.
graphics::Raster8 zhang_suen(const graphics::Raster8& mask) {
  VENATO_EXPECTS(mask.channels == 1);
  // A frame of zeros around the picture: no neighbour needs a test.
  const int w = mask.width + 2, h = mask.height + 2;
  std::vector<unsigned char> p(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0);
  std::vector<std::size_t> alive, next, doomed;
  for (int j = 0; j < mask.height; ++j)
    for (int i = 0; i < mask.width; ++i)
      if (mask.at(i, j)) {
        const std::size_t k = static_cast<std::size_t>(j + 1) * static_cast<std::size_t>(w) + static_cast<std::size_t>(i + 1);
        p[k] = 1;
        alive.push_back(k);
      }
  const std::array<std::ptrdiff_t, 8> around = neighbours(w);
  for (bool changed = true; changed;) {
    changed = false;
    for (int step = 0; step < 2; ++step) {
      doomed.clear();
      for (const std::size_t k : alive) {
        std::array<int, 9> n{};
        int count = 0, rises = 0;
        for (std::size_t a = 0; a < 8; ++a) {
          n[a] = p[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) + around[a])];
          count += n[a];
        }
        n[8] = n[0];
        for (std::size_t a = 0; a < 8; ++a) rises += !n[a] && n[a + 1];
        if (count < 2 || count > 6 || rises != 1) continue;
        const bool first = !(n[0] && n[2] && n[4]) && !(n[2] && n[4] && n[6]);
        const bool second = !(n[0] && n[2] && n[6]) && !(n[0] && n[4] && n[6]);
        if (step == 0 ? first : second) doomed.push_back(k);
      }
      for (const std::size_t k : doomed) p[k] = 0;
      if (doomed.empty()) continue;
      changed = true;
      next.clear();
      for (const std::size_t k : alive)
        if (p[k]) next.push_back(k);
      alive.swap(next);
    }
  }
  graphics::Raster8 out(mask.width, mask.height, 1, mask.pitch_m);
  for (const std::size_t k : alive)
    out.at(static_cast<int>(k % static_cast<std::size_t>(w)) - 1, static_cast<int>(k / static_cast<std::size_t>(w)) - 1) = 255;
  return out;
}

graphics::Raster8 skeleton(const graphics::Raster8& mask) {
  graphics::Raster8 out = zhang_suen(mask);
  // Zhang-Suen leaves staircases two pixels thick on oblique lines: take out corners whose two sides touch diagonally anyway.
  // Source: after C. M. Holt et al., Comm. ACM 30 (1987) 156.
  static constexpr std::array<int, 8> dx = {0, 1, 1, 1, 0, -1, -1, -1}, dy = {-1, -1, 0, 1, 1, 1, 0, -1};
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i) {
      if (!out.at(i, j)) continue;
      const auto at = [&](std::size_t a) {
        const int x = i + dx[a % 8], y = j + dy[a % 8];
        return x >= 0 && y >= 0 && x < out.width && y < out.height && out.at(x, y);
      };
      for (std::size_t a = 0; a < 8; a += 2) {
        const bool corner = at(a) && at(a + 2) && !at(a + 1) && !at(a + 5) && !(at(a + 4) && at(a + 6));
        const bool keeps_others = (!at(a + 4) || at(a + 3)) && (!at(a + 6) || at(a + 7)) && (!at(a + 3) || at(a + 2)) && (!at(a + 7) || at(a));
        if (corner && keeps_others) {
          out.at(i, j) = 0;
          break;
        }
      }
    }
  return out;
}
}  // namespace venato::sync
