#include <omp.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
/// f(k) for every k in [first, last) whose byte is 1, without looking at the others.
template <class F>
inline void for_marked(const std::uint8_t* mark, std::int32_t first, std::int32_t last, const F& f) {
  for (std::int32_t k = first; k < last; k += 8) {
    std::uint64_t word;
    std::memcpy(&word, mark + k, 8);  // the lists are padded
    if (last - k < 8) word &= (std::uint64_t{1} << (8 * (last - k))) - 1;
    for (; word != 0; word &= word - 1) f(static_cast<std::size_t>(k) + static_cast<std::size_t>(std::countr_zero(word)) / 8);
  }
}

class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(omp_get_wtime()) {}
  ~Stopwatch() { sum_ += omp_get_wtime() - start_; }

 private:
  double& sum_;
  double start_;
};

template <class F>
void timed(double& sum, const F& f) {
  const Stopwatch watch(sum);
  f();
}
}  // namespace

void Simulation::Impl::step_once() {
  if (!forces_valid) evaluate();
  const double dt = setup.time_step_s;
  ++step_count;
  timed(stats.seconds_walls, [&] { move_walls(time()); });
  timed(stats.seconds_integrate, [&] { advance(); });
  if (list_is_stale()) timed(stats.seconds_list, [&] { rebuild_list(); });
  timed(stats.seconds_contact, [&] { contact_forces(dt); });
  pending = true;
  settle_books(dt);
  ++stats.steps;
}

/// Forces of the present positions and velocities: springs turn and stretch by nothing in a step of length zero.
void Simulation::Impl::evaluate() {
  finish_step();
  if (!list_valid) rebuild_list();
  for (BlockBook& b : books) b = BlockBook();
  contact_forces(0);
  for (std::size_t s = 0; s < sphere.size(); ++s) load[s] = contact_load(s);
  settle_books(0);
  forces_valid = true;
}

void Simulation::Impl::move_walls(double t) {
  for (WallModel& w : walls) {
    w.pose_before = w.pose;
    w.pose = wall_pose(w.wall.motion, t);
    w.step_velocity_m_s = (w.pose.offset_m - w.pose_before.offset_m) / setup.time_step_s;
  }
}

Load Simulation::Impl::contact_load(std::size_t s) const {
  Load sum;
  for_marked(pairs.in_touching.data(), pairs.in_first[s], pairs.in_first[s + 1], [&](std::size_t k) {
    const PairForce& f = pairs.force[static_cast<std::size_t>(pairs.in_pair[k])];
    sum.force = sum.force - f.on_i, sum.torque = sum.torque + f.torque_j;
  });
  for_marked(pairs.touching.data(), pairs.first[s], pairs.first[s + 1], [&](std::size_t p) {
    const PairForce& f = pairs.force[p];
    sum.force = sum.force + f.on_i, sum.torque = sum.torque + f.torque_i;
  });
  for (std::size_t k = 0; k < wall_list.contact_count[s]; ++k) {
    const WallContact& w = wall_list.contact[static_cast<std::size_t>(wall_list.contact_first[s]) + k];
    sum.force = sum.force + w.on_grain, sum.torque = sum.torque + w.torque_on_grain;
  }
  return sum;
}

inline void Simulation::Impl::kick(Motion& m, const Load& l, double half) const {
  const double falls = m.inverse_mass > 0 ? half : 0.0;
  const Vec3& g = setup.gravity_m_s2;
  m.velocity = m.velocity + (half * m.inverse_mass) * l.force + falls * Trio{g.x(), g.y(), g.z()};
  m.spin = m.spin + (half * m.inverse_inertia) * l.torque;
}

void Simulation::Impl::finish_step() {
  if (!pending) return;
  const double half = 0.5 * setup.time_step_s;
  const std::int64_t n = grains();
#pragma omp parallel for schedule(static) num_threads(team()) if (team() > 1)
  for (std::int64_t i = 0; i < n; ++i) {
    const std::size_t s = static_cast<std::size_t>(i);
    load[s] = contact_load(s);
    kick(motion[s], load[s], half);
  }
  pending = false;
}

void Simulation::Impl::advance() {
  const double dt = setup.time_step_s, half = 0.5 * dt, start = time() - dt;
  const double listed_for = static_cast<double>(step_count - step_of_build) * dt;
  const std::int64_t n = grains(), nb = blocks();
  const std::size_t anchored = list_valid ? anchor.size() : 0;
  books.resize(static_cast<std::size_t>(nb));
#pragma omp parallel for schedule(static) num_threads(team()) if (team() > 1)
  for (std::int64_t b = 0; b < nb; ++b) {
    BlockBook& book = books[static_cast<std::size_t>(b)];
    book.strayed = false, book.speed2 = book.overlap = 0, book.fastest = -1, book.contacts = 0, book.loss = {}, book.wall_work = 0;
    for (std::int64_t i = b * kGrainsPerBlock; i < std::min(n, (b + 1) * kGrainsPerBlock); ++i) {
      const std::size_t s = static_cast<std::size_t>(i);
      Motion& m = motion[s];
      Sphere& x = sphere[s];
      const Load sum = pending ? contact_load(s) : load[s];
      if (pending) kick(m, sum, half);
      kick(m, sum, half);
      const double old[3] = {x.x, x.y, x.z};
      x.x += snapped(0, m.velocity.x * dt);
      x.y += snapped(1, m.velocity.y * dt);
      x.z += snapped(2, m.velocity.z * dt);
      if (s < anchored) {
        const double allowance = static_cast<double>(anchor[s].allowance);
        book.strayed |= !(anchor[s].strayed2(x.x, x.y, x.z, listed_for) <= allowance * allowance);  // NaN strays
      }
      const double speed2 = dot(m.velocity, m.velocity);
      if (!(speed2 <= book.speed2)) book.speed2 = speed2, book.fastest = card[s].id;  // NaN wins
      const double now[3] = {x.x, x.y, x.z};
      for (std::size_t c = 0; c < counters.size(); ++c) {
        const Counter& k = counters[c];
        const double a = old[k.axis] - k.position_m, z = now[k.axis] - k.position_m;
        if (k.sign > 0 ? !(a < 0 && z >= 0) : !(a > 0 && z <= 0)) continue;
        const double part = a / (a - z);
        Vec3 at(old[0] + part * (now[0] - old[0]), old[1] + part * (now[1] - old[1]), old[2] + part * (now[2] - old[2]));
        const Vec3 inside = wrapped(at);
        if ((inside.array() < k.window_low.array()).any() || (inside.array() > k.window_high.array()).any()) continue;
        for (int d = 0; d < 3; ++d) at[d] += card[s].image[static_cast<std::size_t>(d)] * box.length[static_cast<std::size_t>(d)];
        book.crossing.push_back({static_cast<int>(c), start + part * dt, part, card[s].id, at, to_vec3(m.velocity), to_vec3(m.spin)});
      }
    }
  }
}

bool Simulation::Impl::strayed() const {
  return std::any_of(books.begin(), books.end(), [](const BlockBook& b) { return b.strayed; });
}

bool Simulation::Impl::list_is_stale() const {
  if (!list_valid || strayed()) return true;
  if (static_cast<double>(step_count - step_of_build) * setup.time_step_s > list_life_s) return true;
  for (const WallModel& w : walls)
    if (!w.endless && pose_distance(w.wall.motion, w.pose_at_build, w.pose, w.reach_m) > w.listed_way_m) return true;
  return false;
}

void Simulation::Impl::settle_books(double dt) {
  std::fill(wall_load.begin(), wall_load.end(), WallLoad());
  double speed2 = 0;
  GrainId fastest = -1;
  stats.contact_count = 0;
  for (BlockBook& b : books) {
    for (std::size_t w = 0; w < b.wall.size(); ++w) {
      wall_load[w].force_n += b.wall[w].force_n;
      wall_load[w].torque_n_m += b.wall[w].torque_n_m;
    }
    if (!(b.speed2 <= speed2)) speed2 = b.speed2, fastest = b.fastest;
    stats.max_overlap = std::max(stats.max_overlap, b.overlap);
    stats.contact_count += static_cast<double>(b.contacts);
    lost.normal += b.loss.normal, lost.tangential_damping += b.loss.tangential_damping;
    lost.sliding += b.loss.sliding, lost.rolling += b.loss.rolling;
    wall_work += b.wall_work;
    crossings.insert(crossings.end(), b.crossing.begin(), b.crossing.end());
    b.crossing.clear();
  }
  for (std::size_t w = 0; w < walls.size(); ++w) wall_impulse[w] += dt * wall_load[w].force_n;
  stats.pair_count = static_cast<double>(pairs.pair_count());
  const double speed = std::sqrt(speed2);
  if (!(speed <= stats.max_speed_m_s) && fastest >= 0) stats.max_speed_m_s = speed, stats.fastest = fastest;
}
}  // namespace venato::dem
