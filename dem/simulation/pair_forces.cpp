#include <algorithm>
#include <bit>
#include <cmath>

#include "dem/contact/eepa/batch.h"
#include "dem/contact/hertz_mindlin/batch.h"
#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
/// Works through the pairs of blocks: finds those that touch, puts them into lanes, evaluates the law, puts the results into the pairs' slots.
template <class L>
class BatchRunner {
 public:
  BatchRunner(Simulation::Impl& sim, const LawTable<L>& table, double dt) : sim_(sim), view_(sim.pair_view()), table_(table), dt_(dt) {
    if (sim.one_material && !sim.card.empty()) {
      const std::int32_t m = sim.card.front().material;
      for (int l = 0; l < kBatchWidth; ++l) set_law(l, table.of(m, m));
    }
  }

  void run(std::size_t first_pair, std::size_t last_pair, BlockBook& book) {
    for (std::size_t from = first_pair; from < last_pair; from += kScanChunk) {
      const std::size_t found = find_touching(view_, from, std::min(last_pair, from + kScanChunk), touching_);
      book.contacts += static_cast<std::int64_t>(found);
      for (std::size_t k = 0; k < found; k += kBatchWidth)
        evaluate(touching_ + k, static_cast<int>(std::min<std::size_t>(kBatchWidth, found - k)), book);
    }
  }

 private:
  void evaluate(const std::uint32_t* pair, int count, BlockBook& book) {
    const int lanes = (count + 7) / 8 * 8;
    load_lanes(view_, pair, count, b_);
    if (!sim_.one_material)
      for (int l = 0; l < lanes; ++l) {
        const std::size_t p = pair[std::min(l, count - 1)];
        set_law(l, table_.of(material(view_.i[p]), material(view_.j[p])));
      }
    for (int l = 0; l < lanes; ++l)
      if (b_.inverse_mass_i[l] + b_.inverse_mass_j[l] == 0) both_frozen(l, pair[std::min(l, count - 1)]);
    if (sim_.setup.track_energy && dt_ > 0) account(count, book);
    evaluate_batch(static_cast<const L*>(nullptr), b_, lanes, dt_);
    constexpr double kBelow = 1 - 1e-12;  // rounding of the comparison must not decide: the maximum is the same in any order
    for (std::uint32_t deep = store_lanes(view_, pair, count, b_, kBelow * book.overlap); deep != 0; deep &= deep - 1) {
      const int l = std::countr_zero(deep);
      book.overlap = std::max(book.overlap, b_.overlap[l] / std::min(b_.radius_i[l], b_.radius_j[l]));
    }
  }
  std::int32_t material(std::int32_t slot) const { return sim_.card[static_cast<std::size_t>(slot)].material; }
  void both_frozen(int l, std::size_t p) {  // neither is accelerated, but the contact has the stiffness and damping of the real grains
    b_.inverse_mass_i[l] = 1 / sim_.card[static_cast<std::size_t>(view_.i[p])].mass;
    b_.inverse_mass_j[l] = 1 / sim_.card[static_cast<std::size_t>(view_.j[p])].mass;
  }
  void set_law(int l, const L& law) {
    const double* members = reinterpret_cast<const double*>(&law);
    for (int k = 0; k < L::parameter_count; ++k) b_.parameter[k][l] = members[k];
  }
  /// Second, scalar evaluation for the energy book.
  void account(int count, BlockBook& book) {
    for (int l = 0; l < count; ++l) {
      const PairFrame f = pair_frame(b_, l, dt_);
      L law;
      double* members = reinterpret_cast<double*>(&law);
      for (int k = 0; k < L::parameter_count; ++k) members[k] = b_.parameter[k][l];
      const ContactHistory before = history_of(b_, l);
      ContactHistory after = before;
      const ContactForce force = law.force(f.g, after, dt_);
      const ContactLoss loss = law.loss(f.g, before, after, force, dt_);
      book.loss.normal += loss.normal, book.loss.tangential_damping += loss.tangential_damping;
      book.loss.sliding += loss.sliding, book.loss.rolling += loss.rolling;
    }
  }

  static_assert(sizeof(L) == sizeof(double) * L::parameter_count && L::parameter_count <= kMaxParameters);
  PairBatch b_;
  std::uint32_t touching_[kScanChunk + 8];
  Simulation::Impl& sim_;
  const PairView view_;
  const LawTable<L>& table_;
  double dt_;
};
}  // namespace

PairView Simulation::Impl::pair_view() {
  PairView v{sphere.data(),
             motion.data(),
             pairs.i.data(),
             pairs.j.data(),
             pairs.in_place.data(),
             pairs.touching.data(),
             pairs.in_touching.data(),
             pairs.history.data(),
             pairs.force.data(),
             {box.length[0], box.length[1], box.length[2]},
             {},
             box.periodic(0) || box.periodic(1) || box.periodic(2)};
  for (std::size_t a = 0; a < 3; ++a) v.inverse_length[a] = box.length[a] > 0 ? 1 / box.length[a] : 0.0;
  return v;
}

void Simulation::Impl::contact_forces(double dt) {
  const std::int64_t n = grains(), nb = blocks();
  books.resize(static_cast<std::size_t>(nb));
  std::visit(
      [&](const auto& table) {
#pragma omp parallel num_threads(team()) if (team() > 1)
        {
          BatchRunner runner(*this, table, dt);
          std::vector<WallContact> scratch;
#pragma omp for schedule(dynamic, 1)
          for (std::int64_t b = 0; b < nb; ++b) {
            BlockBook& book = books[static_cast<std::size_t>(b)];
            const std::size_t begin = static_cast<std::size_t>(b * kGrainsPerBlock), end = static_cast<std::size_t>(std::min(n, (b + 1) * kGrainsPerBlock));
            runner.run(static_cast<std::size_t>(pairs.first[begin]), static_cast<std::size_t>(pairs.first[end]), book);
            book.wall.assign(walls.size(), WallLoad());
            for (std::size_t s = begin; s < end; ++s)
              if (wall_list.first[s] < wall_list.first[s + 1]) wall_forces(table, s, dt, book, scratch);
          }
        }
      },
      laws);
}
}  // namespace venato::dem
