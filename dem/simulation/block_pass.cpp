#include "dem/simulation/block_pass.h"

#include <omp.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "dem/contact/eepa/batch.h"
#include "dem/contact/hertz_mindlin/batch.h"
#include "dem/contact/liggghts_hertz/batch.h"

namespace venato::dem {
namespace {
constexpr std::size_t kLinesPerBatch = 24;

template <class L>
void set_law(PairBatch& batch, int l, const L& law) {
  static_assert(sizeof(L) == sizeof(double) * L::parameter_count && L::parameter_count <= kMaxParameters);
  const double* members = reinterpret_cast<const double*>(&law);
  for (int k = 0; k < L::parameter_count; ++k) batch.parameter[k][l] = members[k];
}

/// Second, scalar evaluation for the energy book. A pair that stands in two blocks counts where its first grain has the lower slot.
template <class L>
void account(const PairView& v, const PairBatch& batch, const std::uint32_t* pair, int count, double dt, BlockBook& book) {
  for (int l = 0; l < count; ++l) {
    const std::size_t i = v.first(pair[l]), j = v.second(pair[l]);
    if (PairList::block_of(i) != PairList::block_of(j) && i > j) continue;
    const PairFrame f = pair_frame(batch, l, dt);
    L law;
    double* members = reinterpret_cast<double*>(&law);
    for (int k = 0; k < L::parameter_count; ++k) members[k] = batch.parameter[k][l];
    const ContactHistory before = history_of(batch, l);
    ContactHistory after = before;
    const ContactForce force = force_of(law, f.g, after, dt);
    const ContactLoss loss = law.loss(f.g, before, after, force, dt);
    book.loss.normal += loss.normal, book.loss.tangential_damping += loss.tangential_damping;
    book.loss.sliding += loss.sliding, book.loss.rolling += loss.rolling;
  }
}

template <class L>
void evaluate(Simulation::Impl& sim, const LawTable<L>& table, const PairView& v, const std::uint32_t* pair, int count, double dt, PairBatch& batch,
              BlockBook& book) {
  const int lanes = (count + 7) / 8 * 8;
  load_lanes(v, pair, count, batch);
  for (int l = 0; l < lanes && !sim.one_material; ++l) {
    const std::size_t p = pair[std::min(l, count - 1)];
    set_law(batch, l, table.of(sim.card[v.first(p)].material, sim.card[v.second(p)].material));
  }
  // Two frozen grains: neither is accelerated, but the contact has the stiffness and damping of the real ones.
  for (int l = 0; l < lanes && sim.any_frozen; ++l)
    if (batch.inverse_mass_i[l] + batch.inverse_mass_j[l] == 0) {
      const std::size_t p = pair[std::min(l, count - 1)];
      batch.inverse_mass_i[l] = 1 / sim.card[v.first(p)].mass, batch.inverse_mass_j[l] = 1 / sim.card[v.second(p)].mass;
    }
  if (sim.setup.track_energy && dt > 0) account<L>(v, batch, pair, count, dt, book);
  evaluate_batch(static_cast<const L*>(nullptr), batch, lanes, dt);
  constexpr double kBelow = 1 - 1e-12;  // rounding of the comparison must not decide: the maximum is the same in any order
  for (std::uint32_t deep = add_lanes(v, pair, count, batch, kBelow * book.overlap); deep != 0; deep &= deep - 1) {
    const int l = std::countr_zero(deep);
    book.overlap = std::max(book.overlap, batch.overlap[l] / std::min(batch.radius_i[l], batch.radius_j[l]));
  }
}
}  // namespace

PairView Simulation::Impl::pair_view(std::size_t b, LoadRow* sum) {
  const std::size_t first = static_cast<std::size_t>(pairs.block_first[b]);
  PairView v{sphere.data(),
             motion.data(),
             PairList::block_start(b),
             pairs.own.data() + first,
             pairs.partner.data() + first,
             pairs.touching.data() + first,
             pairs.place.data() + first,
             pairs.contacts[b].rows.size() > 0 ? pairs.contacts[b].rows.data()->v : nullptr,
             pairs.history_width,
             sum,
             nullptr,
             {box.length[0], box.length[1], box.length[2]},
             {},
             box.periodic(0) || box.periodic(1) || box.periodic(2)};
  for (std::size_t a = 0; a < 3; ++a) v.inverse_length[a] = box.length[a] > 0 ? 1 / box.length[a] : 0.0;
  return v;
}

template <class L>
void block_forces(Simulation::Impl& sim, const LawTable<L>& table, double dt, std::size_t b, BlockScratch& scratch, bool keep, PassClock* clock) {
  PairList& list = sim.pairs;
  BlockBook& book = sim.books[b];
  book.overlap = book.wall_work = 0, book.contact_sides = book.wall_contacts = 0, book.loss = {};
  const std::size_t first = static_cast<std::size_t>(list.block_first[b]), pairs = static_cast<std::size_t>(list.block_first[b + 1]) - first;
  std::fill(std::begin(scratch.sum), std::end(scratch.sum), LoadRow());
  double t = clock ? omp_get_wtime() : 0;
  auto lap = [&](double PassClock::*part) {
    if (!clock) return;
    const double now = omp_get_wtime();
    clock->*part += now - t, t = now;
  };
  for (std::size_t from = 0; from < pairs; from += kScanChunk) {
    PairView v = sim.pair_view(b, scratch.sum);
    find_touching(v, from, std::min(pairs, from + kScanChunk), scratch.touching, scratch.changed);
    for (std::size_t k = 0; k < scratch.changed.count; ++k) {
      const std::size_t p = first + scratch.changed.pair[k];
      if (list.touching[p])
        list.end(b, p);
      else
        list.start(b, p, ContactHistory{});
    }
    v = sim.pair_view(b, scratch.sum);  // new contacts may have moved the histories
    if (keep) list.contacts[b].kept.grow(list.contacts[b].used), v.kept = list.contacts[b].kept.data();
    lap(&PassClock::scan);
    for (std::size_t k = 0; k < scratch.touching.count; k += kBatchWidth) {
      scratch.ahead.some(kLinesPerBatch);
      evaluate(sim, table, v, scratch.touching.pair + k, static_cast<int>(std::min<std::size_t>(kBatchWidth, scratch.touching.count - k)), dt,
               scratch.batch, book);
    }
    lap(&PassClock::contact);
  }
  book.wall.assign(sim.walls.size(), WallSum());
  const std::size_t start = PairList::block_start(b), end = sim.block_end(b);
  for (std::size_t s = start; s < end; ++s)
    if (sim.wall_list.first[s] < sim.wall_list.first[s + 1]) sim.wall_forces(table, s, dt, book, scratch.wall, scratch.sum[s - start]);
  book.contact_sides = list.contacts[b].sides;
  lap(&PassClock::walls);
}
template void block_forces(Simulation::Impl&, const LawTable<HertzMindlin>&, double, std::size_t, BlockScratch&, bool, PassClock*);
template void block_forces(Simulation::Impl&, const LawTable<LiggghtsHertz>&, double, std::size_t, BlockScratch&, bool, PassClock*);
template void block_forces(Simulation::Impl&, const LawTable<Eepa>&, double, std::size_t, BlockScratch&, bool, PassClock*);

void prepare_batch(const Simulation::Impl& sim, PairBatch& batch) {
  std::visit(
      [&](const auto& table) {
        if (!sim.one_material || sim.card.empty()) return;
        const std::int32_t m = sim.card.front().material;
        for (int l = 0; l < kBatchWidth; ++l) set_law(batch, l, table.of(m, m));
      },
      sim.laws);
}

}  // namespace venato::dem
