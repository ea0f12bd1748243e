#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dem/contact/eepa/batch.h"
#include "dem/contact/hertz_mindlin/batch.h"
#include "dem/contact/liggghts_hertz/batch.h"
#include "dem/simulation/impl.h"

namespace venato::dem {
namespace {
constexpr double kSameSurface = 1e-4;  // radii: as touch_mesh() has it for the triangles of one mesh
constexpr double kSameContact = 0.8;   // cosine: from step to step a contact's normal turns by far less, corners of a mesh differ by more

/// Contact of the last step that this touch continues, by the best match of normals; so the history survives going from triangle to triangle, and
/// from one wall to the next of the same material (a seam in a floor).
const WallContact* continued(std::span<const WallContact> before, std::uint32_t& taken, const std::vector<WallModel>& walls, std::int32_t wall,
                             const Trio& normal) {
  const WallContact* best = nullptr;
  std::size_t at = 0;
  const int material = walls[static_cast<std::size_t>(wall)].wall.material;
  for (const bool same_wall : {true, false}) {
    double best_match = kSameContact;
    for (std::size_t k = 0; k < before.size() && k < 32; ++k) {
      const bool same = before[k].wall == wall;
      if (same != same_wall || (taken >> k & 1u) || walls[static_cast<std::size_t>(before[k].wall)].wall.material != material) continue;
      const double match = dot(before[k].normal, normal);
      if (match > best_match) best = &before[k], best_match = match, at = k;
    }
    if (best) break;
  }
  if (best) taken |= 1u << at;
  return best;
}

/// The point (world) lies on the wall; of a mesh only the candidate triangles are looked at.
bool on_surface(const WallModel& w, const int* first, const int* last, const Vec3& point, double tolerance) {
  const Vec3 p = w.into_wall_frame(point);
  if (const auto* plane = std::get_if<PlaneShape>(&w.wall.shape)) return std::abs(plane->normal.dot(p - plane->point)) < tolerance;
  if (const auto* cylinder = std::get_if<CylinderShape>(&w.wall.shape)) {
    const double along = cylinder->axis.dot(p - cylinder->base);
    return along > -tolerance && along < cylinder->length_m + tolerance &&
           std::abs((p - cylinder->base - along * cylinder->axis).norm() - cylinder->radius_m) < tolerance;
  }
  return std::any_of(first, last, [&](int t) {
    return (nearest_on_triangle(w.triangles[static_cast<std::size_t>(t)], p) - p).squaredNorm() < tolerance * tolerance;
  });
}

ContactGeometry wall_frame(const Sphere& x, const Motion& m, double mass, const Trio& n, const Trio& n_before, double overlap,
                           double overlap_before, const Trio& wall_velocity, const Trio& wall_spin, double dt) {
  const Trio dv = wall_velocity - m.velocity, sum = n + n_before;
  const Trio n_half = (1 / length(sum)) * sum;
  ContactGeometry g;
  g.overlap = overlap, g.overlap_before = overlap_before;
  g.approach = -dot(dv, n);
  g.slide = cross(x.r * m.spin, n_half) - across(dv, n_half);  // lever R on walls: the spin identities of verification.md 3.1 hold exactly
  g.roll = across(m.spin - wall_spin, n);
  g.normal = n;
  g.turn = frame_turn(n_before, n, 0.5 * dot(m.spin + wall_spin, n) * dt);
  g.r_eff = x.r;  // R* = R on every wall, also inside cylinders
  g.m_eff = mass;
  g.i_roll = 1.4 * mass * x.r * x.r;
  return g;
}
}  // namespace

/// Touches of all candidate walls, nearest first. Where walls meet in one surface (a seam between two floors) the nearest point of the one lies on
/// the other: that is one contact, not two.
void Simulation::Impl::find_wall_touches(std::size_t s, std::vector<WallTouchAt>& touch) const {
  const Sphere& x = sphere[s];
  const Vec3 centre = wrapped(Vec3(x.x, x.y, x.z));
  auto triangles = [&](const WallCandidate& c) {
    const int* first = wall_list.triangle.data() + c.first_triangle;
    return std::pair(first, first + c.triangle_count);
  };
  touch.clear();
  for (std::int32_t k = wall_list.first[s]; k < wall_list.first[s + 1]; ++k) {
    const WallCandidate& c = wall_list.candidate[static_cast<std::size_t>(k)];
    const WallModel& w = walls[static_cast<std::size_t>(c.wall)];
    if (!w.present(time())) continue;
    const auto [first, last] = triangles(c);
    const MeshTouches touches = touch_wall(w, w.into_wall_frame(centre), x.r, first, last);
    for (int t = 0; t < touches.count; ++t)
      touch.push_back({k, w.point_to_world(touches.touch[t].point), w.direction_to_world(touches.touch[t].normal), touches.touch[t].distance});
  }
  if (touch.size() < 2 || touch.front().candidate == touch.back().candidate) return;  // of one wall: touch_mesh() has seen to it
  std::stable_sort(touch.begin(), touch.end(), [](const WallTouchAt& a, const WallTouchAt& b) { return a.distance < b.distance; });
  const double same = kSameSurface * x.r;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < touch.size(); ++k) {
    const bool covered = std::any_of(touch.begin(), touch.begin() + static_cast<std::ptrdiff_t>(kept), [&](const WallTouchAt& nearer) {
      if (nearer.candidate == touch[k].candidate) return false;
      const WallCandidate& c = wall_list.candidate[static_cast<std::size_t>(nearer.candidate)];
      const auto [first, last] = triangles(c);
      return on_surface(walls[static_cast<std::size_t>(c.wall)], first, last, touch[k].point, same);
    });
    if (!covered) touch[kept++] = touch[k];
  }
  touch.erase(touch.begin() + static_cast<std::ptrdiff_t>(kept), touch.end());
}

template <class L>
void Simulation::Impl::wall_forces(const LawTable<L>& table, std::size_t s, double dt, BlockBook& book, WallScratch& scratch, LoadRow& sum) {
  const Sphere& x = sphere[s];
  const Motion& m = motion[s];
  WallContact* row = wall_list.contact.data() + wall_list.contact_first[s];
  const std::span<const WallContact> before(row, wall_list.contact_count[s]);
  std::uint32_t taken = 0;
  find_wall_touches(s, scratch.touch);
  scratch.contact.clear();
  LoadRow walls_sum;  // added at the end, so that the grain's sum is pairs, then walls
  for (const WallTouchAt& touch : scratch.touch) {
    const WallCandidate& c = wall_list.candidate[static_cast<std::size_t>(touch.candidate)];
    const WallModel& w = walls[static_cast<std::size_t>(c.wall)];
    const Vec3 &normal = touch.normal, &at = touch.point;
    const Trio n = to_trio(normal), wall_velocity = to_trio(w.velocity_at(at, normal)), wall_spin = to_trio(w.wall.motion.rotation_rad_s);
    const WallContact* old = continued(before, taken, walls, c.wall, n);
    WallContact now{c.wall, old ? old->history : ContactHistory{}, n, x.r - touch.distance, {}, {}, {}};
    const ContactHistory earlier = now.history;
    const ContactGeometry g = wall_frame(x, m, card[s].mass, n, old ? old->normal : n, now.overlap, old ? old->overlap : 0.0, wall_velocity, wall_spin, dt);
    const L& law = table.of(card[s].material, w.wall.material);
    now.force = force_of(law, g, now.history, dt);
    now.on_grain = now.force.tangential - now.force.normal * n;
    now.torque_on_grain = x.r * cross(n, now.force.tangential) + now.force.rolling;
    const Trio &f = now.on_grain, &t_on = now.torque_on_grain;
    walls_sum.v[0] += f.x, walls_sum.v[1] += f.y, walls_sum.v[2] += f.z, walls_sum.v[3] += t_on.x, walls_sum.v[4] += t_on.y, walls_sum.v[5] += t_on.z;
    const Vec3 on_wall = -to_vec3(now.on_grain);
    book.wall[static_cast<std::size_t>(c.wall)].add(
        on_wall, Vec3((at - w.wall.motion.rotation_centre - w.pose.offset_m).cross(on_wall) - to_vec3(now.force.rolling)));
    book.overlap = std::max(book.overlap, now.overlap / x.r);
    ++book.wall_contacts;
    if (setup.track_energy && dt > 0) {
      const ContactLoss loss = law.loss(g, earlier, now.history, now.force, dt);
      book.loss.normal += loss.normal, book.loss.tangential_damping += loss.tangential_damping;
      book.loss.sliding += loss.sliding, book.loss.rolling += loss.rolling;
      const Trio push = old ? 0.5 * (old->on_grain + now.on_grain) : 0.5 * now.on_grain;  // trapezoid
      book.wall_work += (dot(push, wall_velocity) + dot(now.force.rolling, wall_spin)) * dt;
    }
    scratch.contact.push_back(now);
  }
  for (int k = 0; k < 6; ++k) sum.v[k] += walls_sum.v[k];
  std::copy(scratch.contact.begin(), scratch.contact.end(), row);
  wall_list.contact_count[s] = static_cast<std::uint8_t>(scratch.contact.size());
}
template void Simulation::Impl::wall_forces(const LawTable<HertzMindlin>&, std::size_t, double, BlockBook&, WallScratch&, LoadRow&);
template void Simulation::Impl::wall_forces(const LawTable<Eepa>&, std::size_t, double, BlockBook&, WallScratch&, LoadRow&);
template void Simulation::Impl::wall_forces(const LawTable<LiggghtsHertz>&, std::size_t, double, BlockBook&, WallScratch&, LoadRow&);
}  // namespace venato::dem
