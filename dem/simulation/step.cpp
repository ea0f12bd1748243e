#include <omp.h>

#include <algorithm>
#include <cmath>

#include "dem/simulation/block_pass.h"

namespace venato::dem {
namespace {
constexpr std::int64_t kClockedBlocks = 16;  // one block in so many is timed
constexpr std::size_t kFetchFrom = 4000;     // grains: smaller systems live in the caches anyway
constexpr std::size_t kStreamFrom = 60000;   // grains: of larger systems (50 MB) no cache keeps a grain until the next step
constexpr std::size_t kGrainsPerFetch = 8, kLinesPerFetch = 40;

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

/// The seconds of a pass, shared out as the sampled clocks say.
void share_out(StepStatistics& stats, double seconds, const std::vector<PassClock>& clocks) {
  PassClock all;
  for (const PassClock& c : clocks) all.scan += c.scan, all.contact += c.contact, all.walls += c.walls, all.integrate += c.integrate;
  const double sum = all.scan + all.contact + all.walls + all.integrate;
  if (!(sum > 0)) return;
  stats.seconds_scan += seconds * all.scan / sum, stats.seconds_contact += seconds * all.contact / sum;
  stats.seconds_walls += seconds * all.walls / sum, stats.seconds_integrate += seconds * all.integrate / sum;
}
}  // namespace

/// The whole step. Velocity Verlet is kick, drift, forces, kick; forces and the second kick wait for the next step's pass over the grains.
void Simulation::Impl::step_once() {
  if (!forces_valid) evaluate(false);  // nobody looks at single contacts before they are made anew
  advance();
  ++step_count;
  timed(stats.seconds_walls, [&] { move_walls(time()); });
  settle_motion();
  if (list_is_stale()) timed(stats.seconds_list, [&] { rebuild_list(); });
  pending = true;
  ++stats.steps;
}

/// Forces of the present positions and velocities: springs turn and stretch by nothing in a step of length zero.
void Simulation::Impl::evaluate(bool each_contact) {
  finish_step();
  if (!list_valid) rebuild_list();
  take_forces(0, each_contact);
  forces_valid = true;
}

void Simulation::Impl::finish_step() {
  if (!pending) return;
  take_forces(setup.time_step_s, true);
  const double half = 0.5 * setup.time_step_s;
  const Trio g = to_trio(setup.gravity_m_s2);
  for (std::size_t s = 0; s < sphere.size(); ++s) {  // the same operations as kick() of pair_lanes.cpp
    Motion& m = motion[s];
    m.velocity = m.velocity + (half * m.inverse_mass) * load[s].force + (m.inverse_mass > 0 ? 1.0 : 0.0) * (half * g);
    m.spin = m.spin + (half * m.inverse_inertia) * load[s].torque;
  }
  pending = false;
}

void Simulation::Impl::move_walls(double t) {
  for (WallModel& w : walls) {
    w.pose_before = w.pose;
    w.pose = wall_pose(w.wall.motion, t);
    w.step_velocity_m_s = (w.pose.offset_m - w.pose_before.offset_m) / setup.time_step_s;
  }
}

BlockScratch& Simulation::Impl::my_scratch() {
  std::unique_ptr<BlockScratch>& mine = thread_scratch[static_cast<std::size_t>(omp_get_thread_num())];
  if (!mine) mine = std::make_unique<BlockScratch>();
  prepare_batch(*this, mine->batch);
  return *mine;
}

void Simulation::Impl::take_forces(double dt, bool each_contact) {
  const std::int64_t nb = blocks();
  books.resize(static_cast<std::size_t>(nb));
  thread_scratch.resize(static_cast<std::size_t>(std::max(setup.threads, 1)));
  load.resize(sphere.size());
  std::visit(
      [&](const auto& table) {
#pragma omp parallel num_threads(team()) if (team() > 1)
        {
          BlockScratch& mine = my_scratch();
#pragma omp for schedule(dynamic, 1)
          for (std::int64_t i = 0; i < nb; ++i) {
            const std::size_t b = static_cast<std::size_t>(i);
            block_forces(*this, table, dt, b, mine, each_contact, nullptr);
            for (std::size_t s = PairList::block_start(b); s < block_end(b); ++s) load[s] = mine.sum[s - PairList::block_start(b)].load();
          }
        }
      },
      laws);
  settle_contacts(dt);
}

void Simulation::Impl::note_crossings(std::size_t block) {
  BlockBook& book = books[block];
  for (std::size_t s = PairList::block_start(block); s < block_end(block); ++s) {
    const Sphere &from = sphere[s], &to = next_sphere[s];
    const double old[3] = {from.x, from.y, from.z}, now[3] = {to.x, to.y, to.z};
    for (std::size_t c = 0; c < counters.size(); ++c) {
      const Counter& k = counters[c];
      const double a = old[k.axis] - k.position_m, z = now[k.axis] - k.position_m;
      if (k.sign > 0 ? !(a < 0 && z >= 0) : !(a > 0 && z <= 0)) continue;
      const double part = a / (a - z);
      Vec3 at(old[0] + part * (now[0] - old[0]), old[1] + part * (now[1] - old[1]), old[2] + part * (now[2] - old[2]));
      const Vec3 inside = wrapped(at);
      if ((inside.array() < k.window_low.array()).any() || (inside.array() > k.window_high.array()).any()) continue;
      for (int d = 0; d < 3; ++d) at[d] += card[s].image[static_cast<std::size_t>(d)] * box.length[static_cast<std::size_t>(d)];
      const Motion& m = next_motion[s];
      book.crossing.push_back({static_cast<int>(c), time() + part * setup.time_step_s, part, card[s].id, at, to_vec3(m.velocity), to_vec3(m.spin)});
    }
  }
}

MoveView Simulation::Impl::move_view(const BlockScratch& mine) const {
  MoveView v{};
  v.sphere = sphere.data(), v.motion = motion.data(), v.load = load.data();
  v.time_step = setup.time_step_s, v.stream = sphere.size() >= kStreamFrom;
  for (int a = 0; a < 3; ++a) v.gravity.v[a] = setup.gravity_m_s2[a], v.snap[a] = snap[static_cast<std::size_t>(a)];
  v.sum = pending ? mine.sum : nullptr;
  return v;
}

/// What the pass over `block` will read and write, and the lists of the one after it (they say which grains to fetch for that one).
void Simulation::Impl::fetch_block(FetchAhead& ahead, std::size_t block) const {
  ahead.restart();
  const std::size_t nb = static_cast<std::size_t>(blocks());
  if (sphere.size() < kFetchFrom || block >= nb) return;
  const std::size_t s = PairList::block_start(block), n = block_end(block) - s, first = static_cast<std::size_t>(pairs.block_first[block]);
  const std::size_t count = static_cast<std::size_t>(pairs.block_first[block + 1]) - first;
  ahead.add(sphere.data() + s, n), ahead.add(motion.data() + s, n);
  ahead.add(pairs.own.data() + first, count), ahead.add(pairs.touching.data() + first, count), ahead.add(pairs.place.data() + first, count);
  ahead.add(pairs.contacts[block].rows.data(), BlockContacts::lines(pairs.contacts[block].used, pairs.history_width));
  if (books[block].watch.near_look()) ahead.add(anchor.data() + s, n);
  if (sphere.size() < kStreamFrom) ahead.add(next_sphere.data() + s, n), ahead.add(next_motion.data() + s, n);
  ahead.add_partners(pairs.partner.data() + first, count, sphere.data(), motion.data());
  if (block + 1 < nb)
    ahead.add(pairs.partner.data() + pairs.block_first[block + 1],
              static_cast<std::size_t>(pairs.block_first[block + 2] - pairs.block_first[block + 1]));
}

void Simulation::Impl::advance() {
  const double began = omp_get_wtime();
  const std::int64_t nb = blocks();
  books.resize(static_cast<std::size_t>(nb));
  thread_scratch.resize(static_cast<std::size_t>(std::max(setup.threads, 1)));
  next_sphere.resize(sphere.size());
  next_motion.resize(sphere.size());
  std::vector<PassClock> clocks(thread_scratch.size());
  const std::int64_t chunk = std::max<std::int64_t>(1, nb / (8 * team()));  // neighbouring blocks share what they read
  std::visit(
      [&](const auto& table) {
#pragma omp parallel num_threads(team()) if (team() > 1)
        {
          BlockScratch& mine = my_scratch();
          PassClock& clock = clocks[static_cast<std::size_t>(omp_get_thread_num())];
#pragma omp for schedule(dynamic, chunk)
          for (std::int64_t i = 0; i < nb; ++i) {
            const std::size_t b = static_cast<std::size_t>(i), start = PairList::block_start(b), end = block_end(b);
            BlockBook& book = books[b];
            const bool clocked = i % kClockedBlocks == 0;
            if (pending) {
              fetch_block(mine.ahead, b + 1);
              block_forces(*this, table, setup.time_step_s, b, mine, false, clocked ? &clock : nullptr);
            }
            const double t = clocked ? omp_get_wtime() : 0;
            MoveView v = move_view(mine);
            v.next_sphere = next_sphere.data(), v.next_motion = next_motion.data();
            std::copy_n(book.watch.centre, 4, v.centre);
            MoveBook moved;
            for (std::size_t s = start; s < end; s += kGrainsPerFetch) {
              move_grains(v, s, std::min(end, s + kGrainsPerFetch), moved);
              if (pending) v.sum += kGrainsPerFetch;
              if (pending) mine.ahead.some(kLinesPerFetch);
            }
            if (pending) mine.ahead.rest();
            if (v.stream) flush_stream();
            book.strayed = watch_block(b, moved);
            book.speed2 = moved.speed2;
            book.fastest = moved.fastest < card.size() ? card[moved.fastest].id : -1;
            if (!counters.empty()) note_crossings(b);
            if (clocked) clock.integrate += omp_get_wtime() - t;
          }
        }
      },
      laws);
  if (pending) settle_contacts(setup.time_step_s);
  sphere.swap(next_sphere);
  motion.swap(next_motion);
  share_out(stats, omp_get_wtime() - began, clocks);
}

bool Simulation::Impl::watch_block(std::size_t b, const MoveBook& moved) {
  StrayWatch& watch = books[b].watch;
  const double rounding = 4e-16 * (snap[0] + snap[1] + snap[2]);
  if (watch.all_within(moved.relative, setup.time_step_s, rounding) && std::isfinite(moved.speed2)) return false;
  const std::size_t start = PairList::block_start(b), anchored = std::min(block_end(b), anchor.size()), n = anchored > start ? anchored - start : 0;
  return watch.look({next_sphere.data() + start, n}, {anchor.data() + start, n},
                    static_cast<double>(step_count + 1 - step_of_build) * setup.time_step_s);
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

void Simulation::Impl::settle_contacts(double dt) {
  std::vector<WallSum> on_wall(walls.size());
  double sides = 0, on_walls = 0;
  for (BlockBook& b : books) {
    for (std::size_t w = 0; w < b.wall.size(); ++w) on_wall[w].add(b.wall[w]);
    stats.max_overlap = std::max(stats.max_overlap, b.overlap);
    sides += static_cast<double>(b.contact_sides), on_walls += static_cast<double>(b.wall_contacts);
    lost.normal += b.loss.normal, lost.tangential_damping += b.loss.tangential_damping;
    lost.sliding += b.loss.sliding, lost.rolling += b.loss.rolling;
    wall_work += b.wall_work;
  }
  for (std::size_t w = 0; w < walls.size(); ++w) {
    for (int a = 0; a < 3; ++a) wall_load[w].force_n[a] = on_wall[w].force[a].value(), wall_load[w].torque_n_m[a] = on_wall[w].torque[a].value();
    wall_impulse[w] += dt * wall_load[w].force_n;
  }
  stats.pair_count = static_cast<double>(pairs.pair_count());
  stats.contact_count = 0.5 * sides + on_walls;
}

void Simulation::Impl::settle_motion() {
  double speed2 = 0;
  GrainId fastest = -1;
  for (BlockBook& b : books) {
    if (!(b.speed2 <= speed2)) speed2 = b.speed2, fastest = b.fastest;
    crossings.insert(crossings.end(), b.crossing.begin(), b.crossing.end());
    b.crossing.clear();
  }
  const double speed = std::sqrt(speed2);
  if (!(speed <= stats.max_speed_m_s) && fastest >= 0) stats.max_speed_m_s = speed, stats.fastest = fastest;
}
}  // namespace venato::dem
