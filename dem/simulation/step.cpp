#include <omp.h>

#include <algorithm>
#include <cmath>

#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
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
  timed(stats.seconds_integrate, [&] { kick_and_drift(); });
  if (list_is_stale()) timed(stats.seconds_list, [&] { rebuild_list(); });
  timed(stats.seconds_contact, [&] { pair_forces(dt); });
  timed(stats.seconds_sum, [&] { gather_and_kick(dt); });
  settle_books(dt);
  ++stats.steps;
}

/// Forces of the present positions and velocities: springs turn and stretch by nothing in a step of length zero.
void Simulation::Impl::evaluate() {
  if (!list_valid) rebuild_list();
  for (BlockBook& b : books) b = BlockBook();
  pair_forces(0);
  gather_and_kick(0);
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

void Simulation::Impl::kick_and_drift() {
  const double dt = setup.time_step_s, half = 0.5 * dt, start = time() - dt;
  const std::int64_t n = grains(), nb = blocks();
  books.resize(static_cast<std::size_t>(nb));
#pragma omp parallel for schedule(static) num_threads(team()) if (team() > 1)
  for (std::int64_t b = 0; b < nb; ++b) {
    BlockBook& book = books[static_cast<std::size_t>(b)];
    book.moved2 = book.speed2 = book.overlap = 0, book.fastest = -1, book.contacts = 0, book.loss = {}, book.wall_work = 0;
    for (std::int64_t i = b * kGrainsPerBlock; i < std::min(n, (b + 1) * kGrainsPerBlock); ++i) {
      const std::size_t s = static_cast<std::size_t>(i);
      Motion& m = motion[s];
      Sphere& x = sphere[s];
      m.velocity = m.velocity + (half * m.inverse_mass) * load[s].force;
      m.spin = m.spin + (half * 2.5 * m.inverse_mass / (x.r * x.r)) * load[s].torque;
      const double old[3] = {x.x, x.y, x.z};
      x.x += snapped(0, m.velocity.x * dt);
      x.y += snapped(1, m.velocity.y * dt);
      x.z += snapped(2, m.velocity.z * dt);
      const Trio way = s < sphere_at_build.size() ? Trio{x.x - sphere_at_build[s].x, x.y - sphere_at_build[s].y, x.z - sphere_at_build[s].z} : Trio{};
      book.moved2 = std::max(book.moved2, dot(way, way));
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

bool Simulation::Impl::list_is_stale() const {
  if (!list_valid) return true;
  double moved2 = 0;
  for (const BlockBook& b : books) moved2 = std::max(moved2, b.moved2);
  if (!(moved2 <= 0.25 * skin * skin)) return true;
  for (const WallModel& w : walls)
    if (!w.endless && pose_distance(w.wall.motion, w.pose_at_build, w.pose, w.reach_m) > 0.5 * skin) return true;
  return false;
}

void Simulation::Impl::gather_and_kick(double dt) {
  const std::int64_t n = grains(), nb = blocks();
  const double half = 0.5 * dt;
  const Trio gravity = to_trio(setup.gravity_m_s2);
#pragma omp parallel num_threads(team()) if (team() > 1)
  {
    std::vector<WallContact> scratch;
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t b = 0; b < nb; ++b) {
      BlockBook& book = books[static_cast<std::size_t>(b)];
      book.wall.assign(walls.size(), WallLoad());
      for (std::int64_t i = b * kGrainsPerBlock; i < std::min(n, (b + 1) * kGrainsPerBlock); ++i) {
        const std::size_t s = static_cast<std::size_t>(i);
        Motion& m = motion[s];
        Load sum;
        for (std::int32_t k = pairs.incident_first[s]; k < pairs.incident_first[s + 1]; ++k) {
          const std::uint32_t entry = pairs.incident[static_cast<std::size_t>(k)];
          const std::size_t p = entry >> 1;
          if (!pairs.touching[p]) continue;
          const PairForce& f = pairs.force[p];
          if (entry & 1)
            sum.force = sum.force - f.on_i, sum.torque = sum.torque + f.torque_j;
          else
            sum.force = sum.force + f.on_i, sum.torque = sum.torque + f.torque_i;
        }
        if (wall_list.first[s] < wall_list.first[s + 1]) std::visit([&](const auto& table) { wall_forces(table, s, dt, sum, book, scratch); }, laws);
        sum.force = sum.force + m.mass * gravity;
        load[s] = sum;
        m.velocity = m.velocity + (half * m.inverse_mass) * sum.force;
        m.spin = m.spin + (half * 2.5 * m.inverse_mass / (sphere[s].r * sphere[s].r)) * sum.torque;
      }
    }
  }
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
  stats.pair_count = static_cast<double>(pairs.pair.size());
  const double speed = std::sqrt(speed2);
  if (!(speed <= stats.max_speed_m_s) && fastest >= 0) stats.max_speed_m_s = speed, stats.fastest = fastest;
}
}  // namespace venato::dem
