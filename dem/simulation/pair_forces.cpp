#include <algorithm>

#include "dem/contact/eepa/batch.h"
#include "dem/contact/hertz_mindlin/batch.h"
#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
/// A batch being filled with touching pairs of one block; flush() computes and puts the results in the pairs' slots.
template <class L>
class BatchRunner {
 public:
  BatchRunner(Simulation::Impl& sim, const LawTable<L>& table, double dt, BlockBook& book) : sim_(sim), table_(table), dt_(dt), book_(book) {
    for (int l = 0; l < kBatchWidth; ++l) {  // harmless numbers for lanes that stay empty
      b_.from_i_x[l] = 1.5, b_.from_i_y[l] = b_.from_i_z[l] = b_.dv_x[l] = b_.dv_y[l] = b_.dv_z[l] = 0;
      b_.wi_x[l] = b_.wi_y[l] = b_.wi_z[l] = b_.wj_x[l] = b_.wj_y[l] = b_.wj_z[l] = 0;
      b_.radius_i[l] = b_.radius_j[l] = b_.inverse_mass_i[l] = b_.inverse_mass_j[l] = 1;
      for (auto& h : b_.history) h[l] = 0;
      set_law(l, table.law.front());
    }
    if (sim.one_material && !sim.card.empty()) {
      const std::int32_t m = sim.card.front().material;
      for (int l = 0; l < kBatchWidth; ++l) set_law(l, table.of(m, m));
    }
  }

  void add(std::size_t i, std::size_t p, const Trio& to_j) {
    const std::size_t j = static_cast<std::size_t>(sim_.pairs.pair[p].j);
    const Motion &a = sim_.motion[i], &c = sim_.motion[j];
    const int l = count_++;
    pair_[l] = p;
    b_.from_i_x[l] = to_j.x, b_.from_i_y[l] = to_j.y, b_.from_i_z[l] = to_j.z;
    const Trio dv = c.velocity - a.velocity;
    b_.dv_x[l] = dv.x, b_.dv_y[l] = dv.y, b_.dv_z[l] = dv.z;
    b_.wi_x[l] = a.spin.x, b_.wi_y[l] = a.spin.y, b_.wi_z[l] = a.spin.z;
    b_.wj_x[l] = c.spin.x, b_.wj_y[l] = c.spin.y, b_.wj_z[l] = c.spin.z;
    b_.radius_i[l] = sim_.sphere[i].r, b_.radius_j[l] = sim_.sphere[j].r;
    b_.inverse_mass_i[l] = a.inverse_mass, b_.inverse_mass_j[l] = c.inverse_mass;
    if (a.inverse_mass + c.inverse_mass == 0) b_.inverse_mass_i[l] = 1 / a.mass, b_.inverse_mass_j[l] = 1 / c.mass;  // both frozen
    if (!sim_.one_material) set_law(l, table_.of(sim_.card[i].material, sim_.card[j].material));
    const ContactHistory h = sim_.pairs.touching[p] ? sim_.pairs.history[p] : ContactHistory{};
    b_.history[0][l] = h.spring.x, b_.history[1][l] = h.spring.y, b_.history[2][l] = h.spring.z, b_.history[3][l] = h.contact_radius;
    b_.history[4][l] = h.rolling.x, b_.history[5][l] = h.rolling.y, b_.history[6][l] = h.rolling.z, b_.history[7][l] = h.plastic;
    if (count_ == kBatchWidth) flush();
  }

  void flush() {
    if (count_ == 0) return;
    if (sim_.setup.track_energy && dt_ > 0) account();
    evaluate_batch(static_cast<const L*>(nullptr), b_, std::min(kBatchWidth, (count_ + 7) / 8 * 8), dt_);
    for (int l = 0; l < count_; ++l) {
      const std::size_t p = pair_[l];
      sim_.pairs.force[p] = {{b_.force_x[l], b_.force_y[l], b_.force_z[l]},
                             {b_.torque_i_x[l], b_.torque_i_y[l], b_.torque_i_z[l]},
                             {b_.torque_j_x[l], b_.torque_j_y[l], b_.torque_j_z[l]}};
      sim_.pairs.history[p] = history_of(b_, l);
      sim_.pairs.touching[p] = 1;
    }
    book_.contacts += count_;
    count_ = 0;
  }

 private:
  void set_law(int l, const L& law) {
    const double* members = reinterpret_cast<const double*>(&law);
    for (int k = 0; k < L::parameter_count; ++k) b_.parameter[k][l] = members[k];
  }
  /// Second, scalar evaluation for the energy book.
  void account() {
    for (int l = 0; l < count_; ++l) {
      const PairFrame f = pair_frame(b_, l, dt_);
      L law;
      double* members = reinterpret_cast<double*>(&law);
      for (int k = 0; k < L::parameter_count; ++k) members[k] = b_.parameter[k][l];
      const ContactHistory before = history_of(b_, l);
      ContactHistory after = before;
      const ContactForce force = law.force(f.g, after, dt_);
      const ContactLoss loss = law.loss(f.g, before, after, force, dt_);
      book_.loss.normal += loss.normal, book_.loss.tangential_damping += loss.tangential_damping;
      book_.loss.sliding += loss.sliding, book_.loss.rolling += loss.rolling;
    }
  }

  static_assert(sizeof(L) == sizeof(double) * L::parameter_count);
  PairBatch b_;
  std::size_t pair_[kBatchWidth];
  int count_ = 0;
  Simulation::Impl& sim_;
  const LawTable<L>& table_;
  double dt_;
  BlockBook& book_;
};

template <class L>
void run_block(Simulation::Impl& sim, const LawTable<L>& table, double dt, std::int64_t b) {
  BlockBook& book = sim.books[static_cast<std::size_t>(b)];
  BatchRunner<L> batch(sim, table, dt, book);
  PairList& list = sim.pairs;
  const std::int64_t end = std::min(sim.grains(), (b + 1) * kGrainsPerBlock);
  for (std::size_t i = static_cast<std::size_t>(b * kGrainsPerBlock); i < static_cast<std::size_t>(end); ++i) {
    const Sphere a = sim.sphere[i];
    for (std::size_t p = static_cast<std::size_t>(list.first[i]); p < static_cast<std::size_t>(list.first[i + 1]); ++p) {
      const Pair pair = list.pair[p];
      const Sphere& c = sim.sphere[static_cast<std::size_t>(pair.j)];
      const Trio& shift = sim.image_shift[static_cast<std::size_t>(pair.image)];
      const Trio to_j{(c.x - a.x) + shift.x, (c.y - a.y) + shift.y, (c.z - a.z) + shift.z};
      const double d2 = dot(to_j, to_j), reach = a.r + c.r;
      if (!(d2 < reach * reach)) {
        list.touching[p] = 0;
        continue;
      }
      const double small = std::min(a.r, c.r), near = reach - book.overlap * small;
      if (d2 < near * near) book.overlap = (reach - std::sqrt(d2)) / small;
      batch.add(i, p, to_j);
    }
  }
  batch.flush();
}
}  // namespace

void Simulation::Impl::pair_forces(double dt) {
  const std::int64_t nb = blocks();
  books.resize(static_cast<std::size_t>(nb));
  std::visit(
      [&](const auto& table) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(team()) if (team() > 1)
        for (std::int64_t b = 0; b < nb; ++b) run_block(*this, table, dt, b);
      },
      laws);
}
}  // namespace venato::dem
