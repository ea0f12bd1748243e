#include "dem/time_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "dem/contact/kernels/restitution.h"
#include "dem/psd/check_sizes.h"
#include "dem/run_case.h"

namespace venato::dem {
namespace {
constexpr double kHertzDuration = 2.86828;  // [-] verification.md 0.4; the seed paper prints 2.87

struct SmallestGrain {
  int material;
  double radius_m;
};

/// Smallest grain per material: of the powders (coarse-grained) and of grains handed over (already coarse-grained).
std::vector<SmallestGrain> smallest_grains(const Case& c) {
  std::vector<SmallestGrain> grains;
  const auto n = static_cast<int>(c.materials.materials.size());
  const auto add = [&](int material, double radius) {
    if (material < 0 || material >= n) throw UsageError("case '" + c.name + "': a powder's material index is outside the material table");
    if (!(radius > 0)) throw UsageError("case '" + c.name + "': a grain radius is not > 0");
    const auto same = std::find_if(grains.begin(), grains.end(), [&](const SmallestGrain& g) { return g.material == material; });
    if (same == grains.end())
      grains.push_back({material, radius});
    else
      same->radius_m = std::min(same->radius_m, radius);
  };
  for (const Powder& powder : c.powders) {
    require_sizes(powder.psd, "powder '" + powder.name + "'");
    add(powder.material, 0.5 * powder.psd.lower_cut_m * c.coarse_graining);
  }
  for (const GrainRecord& grain : c.handed_over) {
    if (grain.species < 0 || static_cast<std::size_t>(grain.species) >= c.powders.size())
      throw UsageError("case '" + c.name + "': a handed-over grain names a powder that is not there");
    add(c.powders[static_cast<std::size_t>(grain.species)].material, 0.5 * grain.diameter_m);
  }
  if (grains.empty()) throw UsageError("case '" + c.name + "': no powders, so there is no time step");
  return grains;
}

void require_material(const Material& m, bool grain) {
  const bool bad = !(m.young_modulus_pa > 0) || !(m.poisson_ratio > -1 && m.poisson_ratio <= 0.5) || (grain && !(m.density_kg_m3 > 0));
  if (bad) throw UsageError("material '" + m.name + "': needs E > 0, -1 < nu <= 0.5" + (grain ? std::string(" and a density > 0") : std::string()));
}

double grain_mass(double radius, double density) { return 4.0 / 3 * std::numbers::pi * radius * radius * radius * density; }

double farthest_from(const Vec3& centre, const WallShape& shape, const Box& box) {
  double distance = 0;
  const auto reach = [&](const Vec3& p) { distance = std::max(distance, (p - centre).norm()); };
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
    for (const Triangle& t : mesh->triangles) reach(t.a), reach(t.b), reach(t.c);
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    const Vec3 axis = cylinder->axis.normalized();
    reach(cylinder->base), reach(cylinder->base + cylinder->length_m * axis);
    distance += cylinder->radius_m;
  } else {
    for (int k = 0; k < 8; ++k)
      reach(Vec3(k & 1 ? box.high.x() : box.low.x(), k & 2 ? box.high.y() : box.low.y(), k & 4 ? box.high.z() : box.low.z()));
  }
  return distance;
}
}  // namespace

double rayleigh_time(double radius_m, double density_kg_m3, double young_modulus_pa, double nu) {
  const double shear_modulus = young_modulus_pa / (2 * (1 + nu));
  return std::numbers::pi * radius_m * std::sqrt(density_kg_m3 / shear_modulus) / (0.1631 * nu + 0.8766);
}

double hertz_time(double m_eff, double r_eff, double e_eff, double speed) {
  return kHertzDuration * std::pow(m_eff * m_eff / (r_eff * e_eff * e_eff * speed), 0.2);
}

double effective_modulus(const Material& a, const Material& b) {
  return 1 / ((1 - a.poisson_ratio * a.poisson_ratio) / a.young_modulus_pa + (1 - b.poisson_ratio * b.poisson_ratio) / b.young_modulus_pa);
}

double wall_speed(const Wall& wall, const Box& box) {
  const WallMotion& m = wall.motion;
  double track = 0;
  for (std::size_t k = 0; k + 1 < m.track.size(); ++k)
    track = std::max(track, (m.track[k + 1].offset_m - m.track[k].offset_m).norm() / (m.track[k + 1].time_s - m.track[k].time_s));
  const double spin = m.rotation_rad_s.norm();
  const double rotation = spin > 0 ? spin * farthest_from(m.rotation_centre, wall.shape, box) : 0;
  const double vibration = 2 * std::numbers::pi * m.vibration_hz * m.vibration_amplitude_m.norm();
  return m.velocity_m_s.norm() + track + rotation + vibration + m.surface_velocity_m_s.norm();
}

TimeStepBounds time_step_bounds(const Case& c) {
  const auto& table = c.materials.materials;
  const std::vector<SmallestGrain> grains = smallest_grains(c);
  if (!(c.expected_max_speed_m_s > 0)) throw UsageError("case '" + c.name + "': expected_max_speed_m_s must be > 0");
  TimeStepBounds bounds{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), 1};
  for (const SmallestGrain& g : grains) {
    const Material& a = table[static_cast<std::size_t>(g.material)];
    require_material(a, true);
    const double mass = grain_mass(g.radius_m, a.density_kg_m3);
    bounds.rayleigh_s = std::min(bounds.rayleigh_s, rayleigh_time(g.radius_m, a.density_kg_m3, a.young_modulus_pa, a.poisson_ratio));
    for (const SmallestGrain& h : grains) {
      const Material& b = table[static_cast<std::size_t>(h.material)];
      require_material(b, true);
      const double other = grain_mass(h.radius_m, b.density_kg_m3);
      bounds.hertz_s = std::min(bounds.hertz_s, hertz_time(mass * other / (mass + other), g.radius_m * h.radius_m / (g.radius_m + h.radius_m),
                                                           effective_modulus(a, b), c.expected_max_speed_m_s));
    }
    for (const Wall& wall : c.walls) {
      if (wall.material < 0 || static_cast<std::size_t>(wall.material) >= table.size())
        throw UsageError("wall '" + wall.name + "': its material index is outside the material table");
      const Material& b = table[static_cast<std::size_t>(wall.material)];
      require_material(b, false);
      bounds.hertz_s =
          std::min(bounds.hertz_s, hertz_time(mass, g.radius_m, effective_modulus(a, b), c.expected_max_speed_m_s + wall_speed(wall, c.box)));
    }
  }
  // EEPA unloads k2/k1 times stiffer than the Hertz branch the two times are made for; a contact's own period goes with 1/sqrt(stiffness).
  if (c.law == LawKind::eepa) bounds.stiffening = std::sqrt(std::max(1.0, c.eepa.stiffness_ratio_k2_k1));
  return bounds;
}

double choose_time_step(const Case& c) {
  if (c.time_step_s > 0) return c.time_step_s;
  if (!(c.rayleigh_fraction > 0) || !(c.hertz_fraction > 0)) throw UsageError("case '" + c.name + "': time step fractions must be > 0");
  const TimeStepBounds bounds = time_step_bounds(c);
  const double step = std::min(c.rayleigh_fraction * bounds.rayleigh_s, c.hertz_fraction * bounds.hertz_s) / bounds.stiffening;
  if (!std::isfinite(step) || !(step > 0))
    throw UsageError("case '" + c.name + "': the time step bounds are not finite (check materials, sizes, wall motions)");
  return step;
}

std::vector<StepRestitution> restitution_at_step(const Case& c, double dt) {
  std::vector<StepRestitution> all;
  if (c.law != LawKind::hertz_mindlin_epsd) return all;
  const auto& table = c.materials.materials;
  const std::vector<SmallestGrain> grains = smallest_grains(c);
  auto add = [&](const SmallestGrain& g, int other, double m_eff, double r_eff, double speed) {
    const Material &a = table[static_cast<std::size_t>(g.material)], &b = table[static_cast<std::size_t>(other)];
    const double asked = c.materials.pair(g.material, other).restitution;
    const double alpha = std::sqrt(5.0) * damping_for_restitution(asked);
    const double overlap = std::pow(15 * m_eff * speed * speed / (16 * effective_modulus(a, b) * std::sqrt(r_eff)), 0.4);
    StepRestitution r{a.name, b.name, asked, 0, 0, 2.9432 * overlap / speed / dt};
    if (!(r.steps_per_contact > 1)) return;  // the Hertz bound does not allow it
    constexpr int kPhases = 16;
    for (int k = 0; k < kPhases; ++k) {
      const double e = dem::restitution_at_step(alpha, r.steps_per_contact, (k + 0.5) / kPhases);
      r.got += e / kPhases;
      r.largest_error = std::max(r.largest_error, std::abs(e - asked));
    }
    all.push_back(r);
  };
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const SmallestGrain& g = grains[i];
    const double mass = grain_mass(g.radius_m, table[static_cast<std::size_t>(g.material)].density_kg_m3);
    for (std::size_t k = i; k < grains.size(); ++k) {
      const SmallestGrain& h = grains[k];
      const double other = grain_mass(h.radius_m, table[static_cast<std::size_t>(h.material)].density_kg_m3);
      add(g, h.material, mass * other / (mass + other), g.radius_m * h.radius_m / (g.radius_m + h.radius_m), c.expected_max_speed_m_s);
    }
    std::vector<int> seen;
    for (const Wall& wall : c.walls) {
      if (std::find(seen.begin(), seen.end(), wall.material) != seen.end()) continue;
      seen.push_back(wall.material);
      double fastest = 0;
      for (const Wall& w : c.walls)
        if (w.material == wall.material) fastest = std::max(fastest, wall_speed(w, c.box));
      add(g, wall.material, mass, g.radius_m, c.expected_max_speed_m_s + fastest);
    }
  }
  return all;
}
}  // namespace venato::dem
