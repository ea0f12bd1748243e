#include "dem/fields/continuum_balance.h"

#include <algorithm>
#include <unordered_map>

#include "dem/fields/contact_line.h"
#include "dem/fields/continuum_weights.h"

namespace venato::dem {
namespace {
/// Cell above a face's other cell: -1 along an axis; none at the lower end of a grid that is not periodic.
bool below(const ContinuumGrid& g, std::size_t cell, int axis, std::size_t& out) {
  const auto nx = static_cast<std::size_t>(g.n[0]), ny = static_cast<std::size_t>(g.n[1]);
  int k[3] = {static_cast<int>(cell % nx), static_cast<int>(cell / nx % ny), static_cast<int>(cell / nx / ny)};
  const auto a = static_cast<std::size_t>(axis);
  if (k[a] == 0 && !g.periodic[a]) return false;
  k[a] = (k[a] + g.n[a] - 1) % g.n[a];
  out = g.index(k[0], k[1], k[2]);
  return true;
}
}  // namespace

MomentumBalance momentum_balance(const ContinuumGrid& grid, std::span<const GrainState> grains, std::span<const ContactState> contacts,
                                 const Vec3& gravity) {
  MomentumBalance b;
  for (auto* field : {&b.grain_force, &b.divergence, &b.weight, &b.wall}) field->assign(grid.size(), Vec3::Zero());
  const double scale = 1 / grid.cell_volume_m3();
  CellWeights weights(grid);
  std::unordered_map<GrainId, std::size_t> at;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const GrainState& g = grains[k];
    at.emplace(g.id, k);
    if (g.frozen) continue;
    weights.point(g.position_m);
    weights.for_each(g.position_m, [&](std::size_t c, double w, const Vec3&) {
      b.grain_force[c] += scale * w * g.force_n;
      b.weight[c] += scale * w * g.mass_kg * gravity;
    });
  }
  for (const ContactState& contact : contacts) {
    const ContactLine line = contact_line(contact, grains[at.at(contact.i)], contact.j >= 0 ? &grains[at.at(contact.j)] : nullptr);
    if (line.none) continue;
    const Vec3 branch = line.from - line.to;
    for (int a = 0; a < 3; ++a) {
      if (!grid.resolved(a)) continue;
      weights.line_on_faces(line.from, line.to, a);
      // share on the face [1/m] times cell size = share per cell volume; sigma . face = -f branch_a share
      weights.for_each(line.from, [&](std::size_t c, double w, const Vec3&) {
        const Vec3 traction = -scale * w * branch[a] * line.force_n;
        b.divergence[c] -= traction;
        if (std::size_t lower = 0; below(grid, c, a, lower)) b.divergence[lower] += traction;
      });
    }
    if (!line.wall) continue;
    weights.point(line.to);
    weights.for_each(line.to, [&](std::size_t c, double w, const Vec3&) { b.wall[c] += scale * w * line.force_n; });
  }
  for (std::size_t c = 0; c < grid.size(); ++c) {
    b.largest_residual = std::max(b.largest_residual, (b.grain_force[c] - b.divergence[c] - b.weight[c] - b.wall[c]).norm());
    for (const auto* field : {&b.grain_force, &b.divergence, &b.weight, &b.wall}) b.largest_term = std::max(b.largest_term, (*field)[c].norm());
  }
  return b;
}
}  // namespace venato::dem
