#include "base/error.h"
#include "dem/simulation/archive.h"
#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
constexpr std::uint64_t kMagic = 0x344d45444f4e4556ull;  // "VENODEM4"

std::size_t first_pair(const Simulation::Impl& e, std::size_t block) { return static_cast<std::size_t>(e.pairs.block_first[block]); }

/// Fields of the state in order; the same function writes and reads, so the two cannot drift apart.
template <class Archive, class Impl>
void exchange(Archive& a, Impl& e) {
  a.list(e.sphere), a.list(e.motion), a.list(e.load), a.list(e.card), a.list(e.slot_of_id);
  a.list(e.pairs.block_first), a.raw(e.pairs.own), a.raw(e.pairs.partner), a.raw(e.pairs.touching);
  a.value(e.pairs.grain_count);
  a.list(e.wall_list.first), a.list(e.wall_list.candidate), a.list(e.wall_list.triangle);
  a.list(e.wall_list.contact_first), a.list(e.wall_list.contact_count), a.list(e.wall_list.contact);
  a.list(e.anchor), a.list(e.reach), a.value(e.list_life_s), a.value(e.farthest_m), a.value(e.listed), a.value(e.list_valid);
  a.value(e.step_count), a.value(e.lost), a.value(e.wall_work), a.value(e.step_of_build), a.value(e.reach_experience);
  a.value(e.forces_valid), a.value(e.one_material), a.value(e.any_frozen), a.value(e.living);
  a.list(e.crossings);
}
}  // namespace

std::vector<std::uint8_t> Simulation::save_state() const {
  Impl& e = *impl_;
  e.finish_step();
  ByteWriter w;
  w.value(kMagic);
  w.value(static_cast<std::uint64_t>(e.walls.size()));
  exchange(w, e);
  for (std::size_t b = 0; b + 1 < e.pairs.block_first.size(); ++b)
    for (std::size_t p = first_pair(e, b); p < first_pair(e, b + 1); ++p)
      if (e.pairs.touching[p]) w.value(e.pairs.history_of(b, p)), w.value(e.pairs.contacts[b].kept[e.pairs.place[p]]);
  for (std::size_t k = 0; k < e.walls.size(); ++k) {
    w.value(e.wall_impulse[k]), w.value(e.wall_load[k]);
    w.value(e.walls[k].pose), w.value(e.walls[k].pose_before), w.value(e.walls[k].pose_at_build), w.value(e.walls[k].step_velocity_m_s);
  }
  w.value(e.stats);
  return std::move(w.bytes);
}

void Simulation::load_state(std::span<const std::uint8_t> bytes) {
  Impl& e = *impl_;
  ByteReader r(bytes);
  std::uint64_t magic = 0, walls = 0;
  r.value(magic), r.value(walls);
  if (magic != kMagic || walls != e.walls.size()) throw WorkError("DEM state: the saved state belongs to another program version or another case");
  exchange(r, e);
  e.pairs.place.resize_for_overwrite(e.pairs.pair_count());
  e.pairs.contacts.clear();
  e.pairs.contacts.resize(e.pairs.block_first.empty() ? 0 : e.pairs.block_first.size() - 1);
  for (std::size_t b = 0; b < e.pairs.contacts.size(); ++b)
    for (std::size_t p = first_pair(e, b); p < first_pair(e, b + 1); ++p) {
      if (!e.pairs.touching[p]) continue;
      ContactHistory h;
      r.value(h);
      e.pairs.start(b, p, h);
      e.pairs.contacts[b].kept.grow(e.pairs.contacts[b].used);
      r.value(e.pairs.contacts[b].kept[e.pairs.place[p]]);
    }
  for (std::size_t k = 0; k < e.walls.size(); ++k) {
    r.value(e.wall_impulse[k]), r.value(e.wall_load[k]);
    r.value(e.walls[k].pose), r.value(e.walls[k].pose_before), r.value(e.walls[k].pose_at_build), r.value(e.walls[k].step_velocity_m_s);
  }
  r.value(e.stats);
  if (!r.done()) throw WorkError("DEM state: the saved state is longer than expected (another case?)");
  e.pending = false;
  // The grid is a function of the places and reaches at the last build. The list goes on as it was, so that sums over walls, which are taken in the
  // order of the list, keep their last digit too.
  if (!e.setup.brute_force_neighbours && e.listed > 0) {
    std::vector<Sphere> at_build;
    for (std::size_t s = 0; s < e.anchor.size(); ++s) at_build.push_back({e.anchor[s].x, e.anchor[s].y, e.anchor[s].z, e.reach[s]});
    e.grid.build(at_build, e.box, e.setup.threads, SlotOrder::mixed);
  }
  e.books.resize(static_cast<std::size_t>(e.blocks()));
}
}  // namespace venato::dem
