#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "base/error.h"
#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
constexpr double kWallWay = 0.1;  // of the mean radius: the least that walls may move before the list is made anew

/// f(k) for 0 … n - 1, side by side.
template <class F>
void for_each(std::int64_t n, int threads, const F& f) {
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
  for (std::int64_t k = 0; k < n; ++k) f(static_cast<std::size_t>(k));
}

template <class T>
void permute(std::vector<T>& v, const std::vector<std::int32_t>& source, int threads) {
  std::vector<T> out(source.size());
  for_each(static_cast<std::int64_t>(source.size()), threads, [&](std::size_t k) { out[k] = v[static_cast<std::size_t>(source[k])]; });
  v.swap(out);
}
}  // namespace

std::array<double, 3> Simulation::Impl::wrap_correction(const Sphere& s) const {
  const double p[3] = {s.x, s.y, s.z};
  std::array<double, 3> move{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(box.length[a] > 0)) continue;
    const double turns = std::floor((p[a] - box.low[a]) / box.length[a]);
    move[a] = std::abs(turns) < 1e9 ? turns : 0.0;  // also for a grain that blew up
  }
  return move;
}

Vec3 Simulation::Impl::wrapped(const Vec3& p) const {
  const std::array<double, 3> turns = wrap_correction({p.x(), p.y(), p.z(), 0});
  return {p.x() - turns[0] * box.length[0], p.y() - turns[1] * box.length[1], p.z() - turns[2] * box.length[2]};
}

void Simulation::Impl::rebuild_list() {
  if (list_valid) reach_experience.list_ended(strayed());
  load = std::vector<Load>();  // of the old order, and whoever needs it makes it anew
  std::vector<GrainId> ids(card.size());
  const auto note_ids = [&] { std::transform(card.begin(), card.end(), ids.begin(), [](const GrainCard& c) { return c.id; }); };
  note_ids();
  const ContactEstate estate(pairs, ids, team());
  // 1. living grains, wrapped into the box
  const std::int64_t all = grains();
  const int threads = team();
  for_each(all, threads, [&](std::size_t s) {
    const std::array<double, 3> turns = wrap_correction(sphere[s]);
    double* p[3] = {&sphere[s].x, &sphere[s].y, &sphere[s].z};
    for (std::size_t a = 0; a < 3; ++a) {
      *p[a] -= turns[a] * box.length[a];
      card[s].image[a] += static_cast<std::int32_t>(turns[a]);
    }
  });
  std::vector<std::int32_t> alive;
  alive.reserve(sphere.size());
  for (std::size_t s = 0; s < sphere.size(); ++s)
    if (!card[s].removed) alive.push_back(static_cast<std::int32_t>(s));
  const std::int64_t n = static_cast<std::int64_t>(alive.size());
  std::vector<Sphere> spheres(alive.size());
  std::vector<Trio> velocity(alive.size());
  for_each(n, threads, [&](std::size_t k) {
    const std::size_t s = static_cast<std::size_t>(alive[k]);
    spheres[k] = sphere[s], velocity[k] = motion[s].velocity;
  });
  // 2. how far everybody may go, and spatial order
  ReachPlan plan = plan_reach({spheres, velocity, box, setup.gravity_m_s2.norm(), setup.time_step_s, setup.skin_m, reach_experience, threads});
  list_life_s = plan.life_s, farthest_m = plan.farthest_m;
  std::vector<std::int32_t> order;
  if (setup.brute_force_neighbours) {
    order.resize(alive.size());
    std::iota(order.begin(), order.end(), 0);
  } else {
    for (std::size_t k = 0; k < spheres.size(); ++k) spheres[k].r = plan.reach[k];
    order = grid.build(spheres, box, threads, SlotOrder::mixed);
  }
  spheres = std::vector<Sphere>(), velocity = std::vector<Trio>();  // the search below needs the room
  permute(plan.anchor, order, threads);
  permute(plan.reach, order, threads);
  anchor.swap(plan.anchor), reach.swap(plan.reach);
  for (std::int32_t& k : order) k = alive[static_cast<std::size_t>(k)];  // new slot -> old slot
  // Into the arrays that the next pass will overwrite anyway.
  next_sphere.resize(order.size()), next_motion.resize(order.size());
  for_each(n, threads, [&](std::size_t k) {
    const std::size_t was = static_cast<std::size_t>(order[k]);
    next_sphere[k] = sphere[was], next_motion[k] = motion[was];
  });
  sphere.swap(next_sphere), motion.swap(next_motion);
  permute(card, order, threads);
  for_each(n, threads, [&](std::size_t s) { slot_of_id[static_cast<std::size_t>(card[s].id)] = static_cast<std::int32_t>(s); });
  one_material = std::all_of(card.begin(), card.end(), [&](const GrainCard& c) { return c.material == card.front().material; });
  any_frozen = std::any_of(card.begin(), card.end(), [](const GrainCard& c) { return c.frozen != 0; });
  // 3. pairs and walls, histories carried
  ids.resize(card.size());
  note_ids();
  rebuild_pairs(pairs, estate, {sphere, anchor, reach, list_life_s, ids, order, setup.brute_force_neighbours ? nullptr : &grid, box, threads});
  rebuild_walls(order);
  listed = grains();
  step_of_build = step_count;
  list_valid = true;
  ++stats.list_builds;
  books.resize(static_cast<std::size_t>(blocks()));
  for (BlockBook& b : books) b.watch = StrayWatch();
}

void Simulation::Impl::rebuild_walls(const std::vector<std::int32_t>& old_slot) {
  const std::int64_t n = grains(), nb = blocks();
  WallList old = std::move(wall_list);
  wall_list = WallList();
  const std::size_t old_count = old.contact_count.size();
  double reach_max = 0, r_sum = 0;
  std::vector<double> way(sphere.size());  // of each grain while the list is good
  for (std::size_t s = 0; s < sphere.size(); ++s) {
    const Anchor& a = anchor[s];
    const double drift = std::isfinite(list_life_s) ? list_life_s * length({a.drift_x, a.drift_y, a.drift_z}) : 0.0;
    way[s] = 1.000001 * (static_cast<double>(a.allowance) + drift);
    reach_max = std::max(reach_max, sphere[s].r + way[s]), r_sum += sphere[s].r;
  }
  for (WallModel& w : walls) {
    w.pose_at_build = w.pose;
    const double ahead =
        std::isfinite(list_life_s) ? pose_distance(w.wall.motion, w.pose, wall_pose(w.wall.motion, time() + list_life_s), w.reach_m) : 0.0;
    w.listed_way_m = std::max(kWallWay * r_sum / static_cast<double>(std::max<std::int64_t>(1, n)), std::isfinite(ahead) ? ahead : 0.0);
    const double farthest = reach_max + w.listed_way_m + w.swing_m;
    if (w.is_mesh() && !(w.bins.reach() >= farthest && w.bins.reach() < 2 * farthest)) w.bins.build(w.triangles, 1.3 * farthest);
  }
  struct Rows {
    std::vector<WallCandidate> candidate;
    std::vector<int> triangle;
    std::vector<std::int32_t> end, room;
  };
  std::vector<Rows> rows(static_cast<std::size_t>(nb));
#pragma omp parallel for schedule(dynamic, 1) num_threads(team()) if (team() > 1)
  for (std::int64_t b = 0; b < nb; ++b) {
    Rows& out = rows[static_cast<std::size_t>(b)];
    for (std::int64_t i = b * kGrainsPerBlock; i < std::min(n, (b + 1) * kGrainsPerBlock); ++i) {
      const Sphere& x = sphere[static_cast<std::size_t>(i)];
      std::int32_t room = 0;
      for (std::size_t k = 0; k < walls.size() && !card[static_cast<std::size_t>(i)].frozen; ++k) {
        const WallModel& w = walls[k];
        const Vec3 centre = w.into_wall_frame(wrapped(Vec3(x.x, x.y, x.z)));
        const double near = x.r + way[static_cast<std::size_t>(i)] + w.listed_way_m + w.swing_m;
        const std::int32_t first = static_cast<std::int32_t>(out.triangle.size());
        if (w.is_mesh()) {
          const auto [from, to] = w.bins.near(centre);
          for (const int* t = from; t != to; ++t)
            if ((nearest_on_triangle(w.triangles[static_cast<std::size_t>(*t)], centre) - centre).squaredNorm() < near * near)
              out.triangle.push_back(*t);
          const std::int32_t count = static_cast<std::int32_t>(out.triangle.size()) - first;
          if (count == 0) continue;
          out.candidate.push_back({static_cast<std::int32_t>(k), first, count});
          room += std::min(count, kMaxTouches);
        } else if (w.endless || touch_wall(w, centre, near, nullptr, nullptr).count > 0) {
          out.candidate.push_back({static_cast<std::int32_t>(k), first, 0});
          ++room;
        }
      }
      out.end.push_back(static_cast<std::int32_t>(out.candidate.size()));
      out.room.push_back(room);
    }
  }
  wall_list.first.assign(1, 0);
  wall_list.contact_first.assign(1, 0);
  for (const Rows& r : rows) {
    const std::int32_t base = static_cast<std::int32_t>(wall_list.triangle.size()), before = static_cast<std::int32_t>(wall_list.candidate.size());
    wall_list.triangle.insert(wall_list.triangle.end(), r.triangle.begin(), r.triangle.end());
    for (WallCandidate c : r.candidate) {
      c.first_triangle += base;
      wall_list.candidate.push_back(c);
    }
    for (std::size_t k = 0; k < r.end.size(); ++k) {
      wall_list.first.push_back(before + r.end[k]);
      wall_list.contact_first.push_back(wall_list.contact_first.back() + r.room[k]);
    }
  }
  wall_list.contact.resize(static_cast<std::size_t>(wall_list.contact_first.back()));
  wall_list.contact_count.assign(static_cast<std::size_t>(n), 0);
  for (std::size_t s = 0; s < static_cast<std::size_t>(n); ++s) {
    const std::size_t was = static_cast<std::size_t>(old_slot[s]);
    if (was >= old_count) continue;
    const std::size_t room = static_cast<std::size_t>(wall_list.contact_first[s + 1] - wall_list.contact_first[s]);
    const std::size_t kept = std::min<std::size_t>(old.contact_count[was], room);
    std::copy_n(old.contact.begin() + old.contact_first[was], kept, wall_list.contact.begin() + wall_list.contact_first[s]);
    wall_list.contact_count[s] = static_cast<std::uint8_t>(kept);
  }
}
}  // namespace venato::dem
