#include "dem/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "dem/contact/kernels/mixing.h"
#include "dem/simulation/block_pass.h"

namespace venato::dem {
namespace {
template <class L, class Make>
LawTable<L> make_table(const MaterialTable& m, const Make& make) {
  LawTable<L> t;
  t.materials = m.materials.size();
  for (int a = 0; a < static_cast<int>(t.materials); ++a)
    for (int b = 0; b < static_cast<int>(t.materials); ++b)
      t.law.push_back(b < a ? t.of(b, a) : make(a, b));  // solved once per unordered pair: exactly symmetric
  return t;
}

AnyLawTable make_laws(const SimulationSetup& s) {
  if (s.law == LawKind::eepa) return make_table<Eepa>(s.materials, [&](int a, int b) { return make_eepa(s.materials, s.eepa, a, b); });
  if (s.law == LawKind::liggghts_hertz)
    return make_table<LiggghtsHertz>(s.materials, [&](int a, int b) { return make_liggghts_hertz(s.materials, a, b); });
  return make_table<HertzMindlin>(s.materials, [&](int a, int b) { return make_hertz_mindlin(s.materials, a, b); });
}
}  // namespace

void check_setup(const SimulationSetup& s) {
  check_materials(s.materials);
  if (!(s.time_step_s > 0) || !std::isfinite(s.time_step_s)) throw UsageError("time step " + std::to_string(s.time_step_s) + " s is not > 0");
  if (s.threads < 1) throw UsageError("threads = " + std::to_string(s.threads) + " is outside [1, inf)");
  if (!s.gravity_m_s2.allFinite()) throw UsageError("gravity is not finite");
  for (int a = 0; a < 3; ++a)
    if (s.box.periodic[a] && !(s.box.high[a] > s.box.low[a]))
      throw UsageError("box: periodic along " + std::string(1, "xyz"[a]) + " but its limits are " + std::to_string(s.box.low[a]) + " and " +
                       std::to_string(s.box.high[a]) + " m");
}

Simulation::Impl::Impl(const SimulationSetup& s) : setup(s) {
  check_setup(s);
  laws = make_laws(s);
  pairs.history_width = std::visit([]<class L>(const LawTable<L>&) { return L::history_count <= 6 ? 6u : 8u; }, laws);
  for (int a = 0; a < 3; ++a) {
    if (!s.box.periodic[a]) continue;
    const double extent = std::max({std::abs(s.box.low[a]), std::abs(s.box.high[a]), s.box.high[a] - s.box.low[a]});
    snap[static_cast<std::size_t>(a)] = 1.5 * std::exp2(std::ceil(std::log2(extent)) + 1);  // quantum 2^-51 of the extent: room for the wrap
    setup.box.low[a] = snapped(a, s.box.low[a]);
    setup.box.high[a] = snapped(a, s.box.high[a]);
  }
  box = PeriodicBox::from(setup.box);
}

Simulation::Impl::~Impl() = default;

std::size_t Simulation::Impl::slot(GrainId id) const {
  if (id < 0 || id >= static_cast<GrainId>(slot_of_id.size()) || slot_of_id[static_cast<std::size_t>(id)] < 0)
    throw UsageError("there is no grain " + std::to_string(id));
  return static_cast<std::size_t>(slot_of_id[static_cast<std::size_t>(id)]);
}

Vec3 Simulation::Impl::unwrapped(std::size_t s) const {
  Vec3 p(sphere[s].x, sphere[s].y, sphere[s].z);
  for (int a = 0; a < 3; ++a) p[a] += card[s].image[static_cast<std::size_t>(a)] * box.length[static_cast<std::size_t>(a)];
  return p;
}

GrainId Simulation::Impl::add(const GrainInput& g) {
  const GrainId id = static_cast<GrainId>(slot_of_id.size());
  const std::string who = "grain " + std::to_string(id);
  if (!(g.radius_m > 0) || !std::isfinite(g.radius_m)) throw UsageError(who + ": radius " + std::to_string(g.radius_m) + " m is not > 0");
  if (g.material < 0 || g.material >= static_cast<int>(setup.materials.materials.size()))
    throw UsageError(who + ": material " + std::to_string(g.material) + " is not in the table of " +
                     std::to_string(setup.materials.materials.size()));
  if (!g.position_m.allFinite() || !g.velocity_m_s.allFinite() || !g.spin_rad_s.allFinite()) throw UsageError(who + ": its state is not finite");
  const Material& material = setup.materials.materials[static_cast<std::size_t>(g.material)];
  const double mass = g.mass_kg > 0 ? g.mass_kg : 4.0 / 3.0 * std::numbers::pi * g.radius_m * g.radius_m * g.radius_m * material.density_kg_m3;
  if (!(mass > 0) || !std::isfinite(mass))
    throw UsageError(who + ": material '" + material.name + "' has density " + std::to_string(material.density_kg_m3) +
                     " kg/m3, which gives no mass");
  Vec3 p;
  for (int a = 0; a < 3; ++a) p[a] = snapped(a, g.position_m[a]);
  sphere.push_back({p.x(), p.y(), p.z(), g.radius_m});
  motion.push_back({to_trio(g.velocity_m_s), to_trio(g.spin_rad_s), g.frozen ? 0 : 1 / mass, g.frozen ? 0 : 2.5 / (mass * g.radius_m * g.radius_m)});
  load.push_back({});
  card.push_back({id, mass, g.species, g.material, {0, 0, 0}, static_cast<std::uint8_t>(g.frozen), 0});
  ++living;
  slot_of_id.push_back(static_cast<std::int32_t>(sphere.size()) - 1);
  list_valid = false;
  return id;
}

Simulation::Simulation(const SimulationSetup& setup) : impl_(std::make_unique<Impl>(setup)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

GrainId Simulation::add_grain(const GrainInput& g) {
  impl_->finish_step();
  impl_->forces_valid = false;
  return impl_->add(g);
}
GrainId Simulation::insert_free_grain(const GrainInput& g) {
  impl_->finish_step();
  return impl_->add(g);
}
void Simulation::remove_grain(GrainId id) {
  const std::size_t s = impl_->slot(id);
  impl_->finish_step();
  impl_->card[s].removed = 1;
  --impl_->living;
  impl_->slot_of_id[static_cast<std::size_t>(id)] = -1;
  impl_->list_valid = false;
}
void Simulation::remove_grains(std::span<const GrainId> ids) {
  for (const GrainId id : ids) remove_grain(id);
}
int Simulation::add_wall(const Wall& wall) {
  if (wall.material < 0 || wall.material >= static_cast<int>(impl_->setup.materials.materials.size()))
    throw UsageError("wall '" + wall.name + "': material " + std::to_string(wall.material) + " is not in the table");
  impl_->finish_step();
  WallModel w = make_wall(wall);
  w.pose = w.pose_before = w.pose_at_build = wall_pose(wall.motion, impl_->time());
  impl_->walls.push_back(std::move(w));
  impl_->wall_impulse.push_back(Vec3::Zero());
  impl_->wall_load.emplace_back();
  impl_->list_valid = impl_->forces_valid = false;
  return static_cast<int>(impl_->walls.size()) - 1;
}
void Simulation::set_wall_motion(int wall, const WallMotion& motion) {
  impl_->finish_step();
  WallModel& w = impl_->walls.at(static_cast<std::size_t>(wall));
  Wall changed = w.wall;
  changed.motion = motion;
  WallModel fresh = make_wall(changed);
  fresh.pose = fresh.pose_before = fresh.pose_at_build = wall_pose(motion, impl_->time());
  w = std::move(fresh);
  impl_->list_valid = impl_->forces_valid = false;
}
void Simulation::set_velocity(GrainId id, const Vec3& v, const Vec3& spin) {
  impl_->finish_step();
  Motion& m = impl_->motion[impl_->slot(id)];
  m.velocity = to_trio(v), m.spin = to_trio(spin);
  impl_->forces_valid = false;
}
void Simulation::set_position(GrainId id, const Vec3& p) {
  impl_->finish_step();
  const std::size_t s = impl_->slot(id);
  Sphere& x = impl_->sphere[s];
  x.x = impl_->snapped(0, p.x()), x.y = impl_->snapped(1, p.y()), x.z = impl_->snapped(2, p.z());
  impl_->card[s].image = {0, 0, 0};
  impl_->list_valid = impl_->forces_valid = false;
}
void Simulation::set_gravity(const Vec3& g) {
  impl_->finish_step();
  impl_->setup.gravity_m_s2 = g;
  impl_->forces_valid = false;
}
void Simulation::set_counters(const std::vector<Counter>& counters) {
  for (const Counter& c : counters)
    if (c.axis < 0 || c.axis > 2 || c.sign == 0 || !std::isfinite(c.position_m))
      throw UsageError("counter '" + c.name + "': needs axis 0, 1 or 2, sign +1 or -1 and a finite position");
  impl_->counters = counters;
}
void Simulation::step(std::int64_t n) {
  for (std::int64_t k = 0; k < n; ++k) impl_->step_once();
}
void Simulation::evaluate_forces() { impl_->evaluate(); }
double Simulation::time_s() const { return impl_->time(); }
std::int64_t Simulation::step_number() const { return impl_->step_count; }
double Simulation::time_step_s() const { return impl_->setup.time_step_s; }
int Simulation::threads() const { return impl_->setup.threads; }
}  // namespace venato::dem
