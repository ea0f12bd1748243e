#include "line/commands/deposit_head.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/expects.h"

namespace venato::line {
namespace {
struct Overlap {
  int cell;
  double share;
};  // share of the grid cell that this command cell covers

std::vector<std::vector<Overlap>> overlaps(int commands, double command_m, int cells, double cell_m) {
  std::vector<std::vector<Overlap>> out(static_cast<std::size_t>(commands));
  for (int k = 0; k < commands; ++k) {
    const double a = k * command_m, b = (k + 1) * command_m;
    const int first = std::max(0, static_cast<int>(std::floor(a / cell_m + 1e-9))),
              last = std::min(cells - 1, static_cast<int>(std::ceil(b / cell_m - 1e-9)) - 1);
    for (int c = first; c <= last; ++c) {
      const double width = std::min(b, (c + 1) * cell_m) - std::max(a, c * cell_m);
      if (width > 0) out[static_cast<std::size_t>(k)].push_back({c, width / cell_m});
    }
  }
  return out;
}
}  // namespace

void deposit_head(const FeedHead& head, Bed& bed) {
  const auto it = std::find(bed.powders.begin(), bed.powders.end(), head.powder);
  if (it == bed.powders.end()) throw UsageError("feed head '" + head.name + "' lays powder '" + head.powder + "', which the line does not have");
  const BedGrid& g = bed.grid;
  VENATO_EXPECTS(std::abs(head.prongs * head.prong_pitch_m - g.nx * g.pitch_m) < 1e-6 &&
                 std::abs(head.ticks * head.tick_s * head.belt_speed_m_s - g.ny * g.pitch_m) < 1e-6);
  std::vector<double>& mass = bed.mass[static_cast<std::size_t>(it - bed.powders.begin())];
  const auto across = overlaps(head.prongs, head.prong_pitch_m, g.nx, g.pitch_m);
  const auto along = overlaps(head.ticks, head.tick_s * head.belt_speed_m_s, g.ny, g.pitch_m);
  for (int t = 0; t < head.ticks; ++t)
    for (int p = 0; p < head.prongs; ++p) {
      const double laid =
          head.duty[static_cast<std::size_t>(t) * static_cast<std::size_t>(head.prongs) + static_cast<std::size_t>(p)] * head.full_rate_kg_m2 / g.nz;
      if (laid == 0) continue;
      for (const Overlap& y : along[static_cast<std::size_t>(t)])
        for (const Overlap& x : across[static_cast<std::size_t>(p)])
          for (int layer = 0; layer < g.nz; ++layer)
            mass[(static_cast<std::size_t>(layer) * static_cast<std::size_t>(g.ny) + static_cast<std::size_t>(y.cell)) *
                     static_cast<std::size_t>(g.nx) +
                 static_cast<std::size_t>(x.cell)] += laid * x.share * y.share;
    }
}
}  // namespace venato::line
