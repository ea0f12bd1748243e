#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "dem/contact/kernels/pair_batch.h"
#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
GrainState state_of(const Simulation::Impl& e, std::size_t s) {
  const Motion& m = e.motion[s];
  const GrainCard& c = e.card[s];
  return {c.id,
          e.unwrapped(s),
          to_vec3(m.velocity),
          to_vec3(m.spin),
          to_vec3(e.load[s].force) + c.mass * e.setup.gravity_m_s2,
          to_vec3(e.load[s].torque),
          e.sphere[s].r,
          c.mass,
          c.species,
          c.material,
          c.frozen != 0};
}

/// Slots of living grains by ascending id.
std::vector<std::size_t> by_id(const Simulation::Impl& e) {
  std::vector<std::size_t> slots;
  for (const std::int32_t s : e.slot_of_id)
    if (s >= 0) slots.push_back(static_cast<std::size_t>(s));
  return slots;
}

bool alive(const Simulation::Impl& e, std::size_t s) { return !e.card[s].removed; }

/// Geometry of a touching pair at the present positions, enough for reading (no motion in it).
ContactGeometry resting_geometry(const Simulation::Impl& e, std::size_t i, std::size_t j) {
  const Sphere &a = e.sphere[i], &c = e.sphere[j];
  double d[3] = {c.x - a.x, c.y - a.y, c.z - a.z};
  for (std::size_t k = 0; k < 3; ++k)
    if (e.box.length[k] > 0) d[k] -= std::round(d[k] / e.box.length[k]) * e.box.length[k];
  const Trio to_j{d[0], d[1], d[2]};
  ContactGeometry g{};
  g.normal = (1 / length(to_j)) * to_j;
  g.overlap = g.overlap_before = std::max(0.0, a.r + c.r - length(to_j));
  g.r_eff = a.r * c.r / (a.r + c.r);
  return g;
}

/// f(i, j, history, force on i) for every touching pair, seen from the grain with the lower id.
template <class F>
void for_touching_pairs(const Simulation::Impl& e, const F& f) {
  for (std::size_t b = 0; b + 1 < e.pairs.block_first.size(); ++b)
    for (std::size_t p = static_cast<std::size_t>(e.pairs.block_first[b]); p < static_cast<std::size_t>(e.pairs.block_first[b + 1]); ++p) {
      if (!e.pairs.touching[p]) continue;
      const std::size_t i = PairList::block_start(b) + e.pairs.own[p], j = static_cast<std::size_t>(e.pairs.partner[p]);
      if (e.card[i].id < e.card[j].id && alive(e, i) && alive(e, j)) f(i, j, e.pairs.history_of(b, p), e.pairs.contacts[b].kept[e.pairs.place[p]]);
    }
}
template <class F>
void for_wall_contacts(const Simulation::Impl& e, const F& f) {
  for (std::size_t s = 0; s < e.wall_list.contact_count.size(); ++s)
    for (std::size_t k = 0; k < e.wall_list.contact_count[s]; ++k)
      if (alive(e, s)) f(s, e.wall_list.contact[static_cast<std::size_t>(e.wall_list.contact_first[s]) + k]);
}

/// FNV-1a over 64-bit words.
struct Hash {
  std::uint64_t h = 14695981039346656037ull;
  void add(std::uint64_t v) {
    h = (h ^ v) * 1099511628211ull;
    h ^= h >> 29;
  }
  void add(double v) { add(std::bit_cast<std::uint64_t>(v)); }
  void add(const Trio& t) { add(t.x), add(t.y), add(t.z); }
  void add(const ContactHistory& c) { add(c.spring), add(c.rolling), add(c.plastic); }
};
}  // namespace

std::size_t Simulation::grain_count() const { return static_cast<std::size_t>(impl_->living); }
bool Simulation::has_grain(GrainId id) const {
  return id >= 0 && id < static_cast<GrainId>(impl_->slot_of_id.size()) && impl_->slot_of_id[static_cast<std::size_t>(id)] >= 0;
}
GrainState Simulation::grain(GrainId id) const {
  impl_->finish_step();
  return state_of(*impl_, impl_->slot(id));
}
std::vector<GrainId> Simulation::grain_ids() const {
  std::vector<GrainId> ids;
  for (const std::size_t s : by_id(*impl_)) ids.push_back(impl_->card[s].id);
  return ids;
}
std::vector<GrainState> Simulation::grains() const {
  impl_->finish_step();
  std::vector<GrainState> all;
  for (const std::size_t s : by_id(*impl_)) all.push_back(state_of(*impl_, s));
  return all;
}

std::vector<ContactState> Simulation::contacts() const {
  impl_->finish_step();
  const Impl& e = *impl_;
  std::vector<ContactState> all;
  for_touching_pairs(e, [&](std::size_t i, std::size_t j, const ContactHistory& h, const LoadRow& on_i) {
    const ContactGeometry g = resting_geometry(e, i, j);
    const Load f = on_i.load();
    const Trio across_n = across(f.force, g.normal);
    const Trio rolling = f.torque - (e.sphere[i].r - 0.5 * g.overlap) * cross(g.normal, f.force);
    all.push_back({e.card[i].id, e.card[j].id, -1, g.overlap, to_vec3(g.normal), -dot(f.force, g.normal), to_vec3(h.spring), to_vec3(across_n),
                   to_vec3(h.rolling), to_vec3(rolling), to_vec3(f.force), to_vec3(f.torque)});
  });
  const std::size_t pair_count = all.size();
  for_wall_contacts(e, [&](std::size_t s, const WallContact& c) {
    all.push_back({e.card[s].id, -1, c.wall, c.overlap, to_vec3(c.normal), c.force.normal, to_vec3(c.history.spring), to_vec3(c.force.tangential),
                   to_vec3(c.history.rolling), to_vec3(c.force.rolling), to_vec3(c.on_grain), to_vec3(c.torque_on_grain)});
  });
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(pair_count);
  std::sort(all.begin(), middle, [](const auto& a, const auto& b) { return a.i < b.i || (a.i == b.i && a.j < b.j); });
  std::stable_sort(middle, all.end(), [](const auto& a, const auto& b) { return a.i < b.i || (a.i == b.i && a.wall < b.wall); });
  return all;
}

std::size_t Simulation::wall_count() const { return impl_->walls.size(); }
WallLoad Simulation::wall_load(int wall) const {
  impl_->finish_step();
  return impl_->wall_load.at(static_cast<std::size_t>(wall));
}
Vec3 Simulation::wall_impulse_n_s(int wall) const {
  impl_->finish_step();
  return impl_->wall_impulse.at(static_cast<std::size_t>(wall));
}
Vec3 Simulation::wall_offset_m(int wall) const { return impl_->walls.at(static_cast<std::size_t>(wall)).pose.offset_m; }

double Simulation::mean_contacts() const {
  impl_->finish_step();
  double sides = 0;
  for_touching_pairs(*impl_, [&](auto...) { sides += 2; });
  for_wall_contacts(*impl_, [&](std::size_t, const WallContact&) { sides += 1; });
  const std::size_t n = grain_count();
  return n > 0 ? sides / static_cast<double>(n) : 0;
}
bool Simulation::wall_present(int wall) const { return impl_->walls.at(static_cast<std::size_t>(wall)).present(impl_->time()); }
Vec3 Simulation::wall_point_m(int wall, const Vec3& p) const { return impl_->walls.at(static_cast<std::size_t>(wall)).point_to_world(p); }

EnergyBook Simulation::energy() const {
  impl_->finish_step();
  const Impl& e = *impl_;
  EnergyBook b;
  for (const std::size_t s : by_id(e)) {
    if (e.card[s].frozen) continue;
    const Motion& m = e.motion[s];
    b.kinetic_translation_j += 0.5 * e.card[s].mass * dot(m.velocity, m.velocity);
    b.kinetic_rotation_j += 0.2 * e.card[s].mass * e.sphere[s].r * e.sphere[s].r * dot(m.spin, m.spin);
    b.potential_j -= e.card[s].mass * e.setup.gravity_m_s2.dot(e.unwrapped(s));
  }
  std::visit(
      [&](const auto& table) {
        auto add = [&](const ContactEnergy& c) {
          b.elastic_normal_j += c.elastic_normal, b.elastic_tangential_j += c.elastic_tangential, b.elastic_rolling_j += c.elastic_rolling;
        };
        for_touching_pairs(e, [&](std::size_t i, std::size_t j, const ContactHistory& h, const LoadRow&) {
          add(table.of(e.card[i].material, e.card[j].material).energy(resting_geometry(e, i, j), h));
        });
        for_wall_contacts(e, [&](std::size_t s, const WallContact& c) {
          ContactGeometry g{};
          g.normal = c.normal, g.overlap = g.overlap_before = c.overlap, g.r_eff = e.sphere[s].r;
          add(table.of(e.card[s].material, e.walls[static_cast<std::size_t>(c.wall)].wall.material).energy(g, c.history));
        });
      },
      e.laws);
  b.dissipated_normal_j = e.lost.normal;
  b.dissipated_tangential_damping_j = e.lost.tangential_damping;
  b.dissipated_sliding_j = e.lost.sliding;
  b.dissipated_rolling_j = e.lost.rolling;
  b.wall_work_j = e.wall_work;
  return b;
}

std::vector<Crossing> Simulation::take_crossings() {
  std::vector<Crossing> out;
  out.swap(impl_->crossings);
  std::sort(out.begin(), out.end(), [](const Crossing& a, const Crossing& b) {
    return a.time_s != b.time_s ? a.time_s < b.time_s : (a.id != b.id ? a.id < b.id : a.counter < b.counter);
  });
  return out;
}

bool Simulation::is_free(const Vec3& position, double radius) const {
  const Impl& e = *impl_;
  const Vec3 p = e.wrapped(position);
  auto apart = [&](std::size_t s) {
    if (!alive(e, s)) return true;
    double d[3] = {e.sphere[s].x - p.x(), e.sphere[s].y - p.y(), e.sphere[s].z - p.z()};
    for (std::size_t a = 0; a < 3; ++a)
      if (e.box.length[a] > 0) d[a] -= std::round(d[a] / e.box.length[a]) * e.box.length[a];
    const double reach = radius + e.sphere[s].r;
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] >= reach * reach;
  };
  bool free = true;
  const std::size_t from = e.setup.brute_force_neighbours ? 0 : static_cast<std::size_t>(e.listed);
  for (std::size_t s = from; s < e.sphere.size() && free; ++s) free = apart(s);
  if (free && from > 0)
    e.grid.for_runs_near(p.x(), p.y(), p.z(), radius + e.farthest_m, [&](std::int32_t a, std::int32_t b) {
      for (std::int32_t s = a; s < b && free; ++s) free = apart(static_cast<std::size_t>(e.grid.slot(s)));
    });
  return free;
}

double Simulation::wall_gap_m(const Vec3& position, double radius) const {
  Impl& e = *impl_;
  const Vec3 p = e.wrapped(position);
  double gap = std::numeric_limits<double>::infinity();
  for (WallModel& w : e.walls) {
    if (!w.present(e.time())) continue;
    const Vec3 c = w.into_wall_frame(p);
    if (const auto* plane = std::get_if<PlaneShape>(&w.wall.shape))
      gap = std::min(gap, touch_plane(*plane, c).distance - radius);
    else if (const auto* cylinder = std::get_if<CylinderShape>(&w.wall.shape)) {
      if (const auto t = touch_cylinder(*cylinder, c, cylinder->radius_m)) gap = std::min(gap, t->distance - radius);
    } else {
      if (w.bins.reach() < radius) w.bins.build(w.triangles, 1.3 * radius);  // broad phase, never a result
      const auto [first, last] = w.bins.near(c);
      for (const int* t = first; t != last; ++t)
        gap = std::min(gap, (nearest_on_triangle(w.triangles[static_cast<std::size_t>(*t)], c) - c).norm() - radius);
    }
  }
  return gap;
}

double Simulation::bed_top_m(const Vec3& low, const Vec3& high, double resting_speed_m_s) const {
  impl_->finish_step();
  const Impl& e = *impl_;
  double top = -std::numeric_limits<double>::infinity();
  const std::size_t listed = std::min(e.pairs.grain_count, e.sphere.size());
  std::vector<std::uint8_t> in_contact(e.pairs.grain_count, 0);
  for (std::size_t b = 0; b < e.pairs.contacts.size(); ++b)
    for (std::size_t p = static_cast<std::size_t>(e.pairs.block_first[b]); p < static_cast<std::size_t>(e.pairs.block_first[b + 1]); ++p)
      if (e.pairs.touching[p]) in_contact[PairList::block_start(b) + e.pairs.own[p]] = in_contact[static_cast<std::size_t>(e.pairs.partner[p])] = 1;
  for (std::size_t s = 0; s < listed; ++s) {
    const Sphere& x = e.sphere[s];
    if (!alive(e, s) || x.z <= top) continue;
    const Trio& v = e.motion[s].velocity;
    if (v.x * v.x + v.y * v.y + v.z * v.z > resting_speed_m_s * resting_speed_m_s) continue;
    const Vec3 p = e.wrapped(Vec3(x.x, x.y, x.z));
    if (p.x() < low.x() || p.x() > high.x() || p.y() < low.y() || p.y() > high.y()) continue;
    if (e.wall_list.contact_count[s] > 0 || in_contact[s]) top = x.z;
  }
  return top;
}

std::vector<GrainId> Simulation::grains_outside(const Box& box) const {
  std::vector<GrainId> ids;
  for (std::size_t s = 0; s < impl_->sphere.size(); ++s) {
    if (!alive(*impl_, s)) continue;
    const double p[3] = {impl_->sphere[s].x, impl_->sphere[s].y, impl_->sphere[s].z};
    for (int a = 0; a < 3; ++a)
      if (!box.periodic[a] && !(p[a] >= box.low[a] && p[a] <= box.high[a])) {
        ids.push_back(impl_->card[s].id);
        break;
      }
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::uint64_t Simulation::state_hash() const {
  impl_->finish_step();
  const Impl& e = *impl_;
  Hash h;
  h.add(static_cast<std::uint64_t>(e.step_count));
  for (const std::size_t s : by_id(e)) {
    h.add(static_cast<std::uint64_t>(e.card[s].id));
    const Vec3 p = e.unwrapped(s);
    h.add(p.x()), h.add(p.y()), h.add(p.z()), h.add(e.sphere[s].r);
    h.add(e.motion[s].velocity), h.add(e.motion[s].spin), h.add(e.load[s].force), h.add(e.load[s].torque);
  }
  std::uint64_t contacts = 0;  // sum of hashes: does not depend on the order of slots
  for_touching_pairs(e, [&](std::size_t i, std::size_t j, const ContactHistory& pair, const LoadRow&) {
    Hash c;
    c.add(static_cast<std::uint64_t>(e.card[i].id)), c.add(static_cast<std::uint64_t>(e.card[j].id)), c.add(pair);
    contacts += c.h;
  });
  for_wall_contacts(e, [&](std::size_t s, const WallContact& w) {
    Hash c;
    c.add(static_cast<std::uint64_t>(e.card[s].id)), c.add(static_cast<std::uint64_t>(w.wall)), c.add(w.history), c.add(w.normal);
    contacts += c.h;
  });
  h.add(contacts);
  return h.h;
}

const StepStatistics& Simulation::statistics() const { return impl_->stats; }
void Simulation::reset_statistics() { impl_->stats = StepStatistics(); }
}  // namespace venato::dem
