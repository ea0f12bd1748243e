#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "base/error.h"
#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
// Skin of the list in mean radii, steered by how long lists live: a pouring bed wants a thick one, a resting bed a thin one.
constexpr double kFirstSkin = 0.3, kThinnest = 0.1, kThickest = 0.8;
constexpr std::int64_t kShortLife = 15, kLongLife = 100;

template <class T>
void permute(std::vector<T>& v, const std::vector<std::int32_t>& source) {
  std::vector<T> out;
  out.reserve(source.size());
  for (const std::int32_t k : source) out.push_back(v[static_cast<std::size_t>(k)]);
  v.swap(out);
}

double chosen_skin(const Simulation::Impl& e, double r_mean, double r_max) {
  double skin = e.setup.skin_m;
  if (!(skin > 0)) {
    skin = e.skin > 0 ? e.skin : kFirstSkin * r_mean;
    const std::int64_t life = e.step_count - e.step_of_build;
    if (e.list_valid && life < kShortLife) skin *= 1.15;
    if (e.list_valid && life > kLongLife) skin *= 0.9;
    skin = std::clamp(skin, kThinnest * r_mean, kThickest * r_mean);
  }
  for (int a = 0; a < 3; ++a)
    if (e.box.periodic(a)) {
      const double length = e.box.length[static_cast<std::size_t>(a)];
      if (length < 4.2 * r_max)
        throw UsageError("box: the periodic length along " + std::string(1, "xyz"[a]) + " is " + std::to_string(length * 1e3) +
                         " mm; it must be at least 2.1 diameters of the largest grain = " + std::to_string(4.2 * r_max * 1e3) +
                         " mm, or a grain would touch two images of another (widen the slice or lower the coarse graining)");
      skin = std::min(skin, 0.49 * length - 2 * r_max);
    }
  return skin;
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
  // 1. living grains, wrapped into the box
  std::vector<std::int32_t> alive;
  std::vector<Sphere> spheres;
  alive.reserve(sphere.size());
  spheres.reserve(sphere.size());
  double r_sum = 0, r_max = 0;
  for (std::size_t s = 0; s < sphere.size(); ++s) {
    if (card[s].removed) continue;
    const std::array<double, 3> turns = wrap_correction(sphere[s]);
    double* p[3] = {&sphere[s].x, &sphere[s].y, &sphere[s].z};
    for (std::size_t a = 0; a < 3; ++a) {
      *p[a] -= turns[a] * box.length[a];
      card[s].image[a] += static_cast<std::int32_t>(turns[a]);
    }
    alive.push_back(static_cast<std::int32_t>(s));
    spheres.push_back(sphere[s]);
    r_sum += sphere[s].r, r_max = std::max(r_max, sphere[s].r);
  }
  skin = alive.empty() ? 0 : chosen_skin(*this, r_sum / static_cast<double>(alive.size()), r_max);
  // 2. spatial order
  std::vector<std::int32_t> order;
  if (setup.brute_force_neighbours) {
    order.resize(alive.size());
    std::iota(order.begin(), order.end(), 0);
  } else {
    order = grid.build(spheres, box, skin, team());
  }
  for (std::int32_t& k : order) k = alive[static_cast<std::size_t>(k)];  // new slot -> old slot
  permute(sphere, order);
  permute(motion, order);
  permute(load, order);
  permute(card, order);
  for (std::size_t s = 0; s < card.size(); ++s) slot_of_id[static_cast<std::size_t>(card[s].id)] = static_cast<std::int32_t>(s);
  one_material = std::all_of(card.begin(), card.end(), [&](const GrainCard& c) { return c.material == card.front().material; });
  // 3. pairs and walls, histories carried
  std::vector<GrainId> ids(card.size());
  std::transform(card.begin(), card.end(), ids.begin(), [](const GrainCard& c) { return c.id; });
  rebuild_pairs(pairs, spare_pairs, {sphere, ids, order, setup.brute_force_neighbours ? nullptr : &grid, box, skin, team()});
  rebuild_walls(order);
  sphere_at_build = sphere;
  for (WallModel& w : walls) w.pose_at_build = w.pose;
  listed = grains();
  step_of_build = step_count;
  list_valid = true;
  ++stats.list_builds;
  books.resize(static_cast<std::size_t>(blocks()));
}

void Simulation::Impl::rebuild_walls(const std::vector<std::int32_t>& old_slot) {
  const std::int64_t n = grains(), nb = blocks();
  WallList old = std::move(wall_list);
  wall_list = WallList();
  const std::size_t old_count = old.contact_count.size();
  double r_max = 0;
  for (const Sphere& s : sphere) r_max = std::max(r_max, s.r);
  for (WallModel& w : walls) {
    const double reach = r_max + skin + w.swing_m;
    if (w.is_mesh() && !(w.bins.reach() >= reach && w.bins.reach() < 2 * reach)) w.bins.build(w.triangles, 1.3 * reach);
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
        const double reach = x.r + skin + w.swing_m;
        const std::int32_t first = static_cast<std::int32_t>(out.triangle.size());
        if (w.is_mesh()) {
          const auto [from, to] = w.bins.near(centre);
          for (const int* t = from; t != to; ++t)
            if ((nearest_on_triangle(w.triangles[static_cast<std::size_t>(*t)], centre) - centre).squaredNorm() < reach * reach)
              out.triangle.push_back(*t);
          const std::int32_t count = static_cast<std::int32_t>(out.triangle.size()) - first;
          if (count == 0) continue;
          out.candidate.push_back({static_cast<std::int32_t>(k), first, count});
          room += std::min(count, kMaxTouches);
        } else if (w.endless || touch_wall(w, centre, reach, nullptr, nullptr).count > 0) {
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
