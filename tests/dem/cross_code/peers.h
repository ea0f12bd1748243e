#pragma once
/// Set-ups of two runs of LIGGGHTS-PUBLIC 3.8.0 (Debian 12 build, "model hertz tangential history rolling_friction epsd") rebuilt for our engine:
/// case H, a flat-bottomed slot hopper, and case A, a cylinder lifted off a heap. Geometry, materials and times as in its input decks; the numbers
/// that it gave stand in the tests.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/rng.h"
#include "dem/simulation/simulation.h"

namespace venato::dem::peers {

/// Both decks: E = 10 MPa, nu = 0.25, rho = 2000, e = 0.4, mu = 0.5, eta_r = 0.3 for grains and walls.
inline MaterialTable materials(double rolling_friction) { return {{{"grain", 2000, 1e7, 0.25}}, {{0.4, 0.5, rolling_friction, 0.3}}}; }
inline SimulationSetup setup(double rolling_friction, double time_step_s, int threads, LawKind law) {
  SimulationSetup s;
  s.law = law;
  s.materials = materials(rolling_friction);
  s.time_step_s = time_step_s;
  s.gravity_m_s2 = Vec3(0, 0, -9.81);
  s.threads = threads;
  return s;
}
inline Wall wall(WallShape shape) {
  Wall w;
  w.shape = std::move(shape);
  return w;
}
inline GrainInput sphere(const Vec3& at, double diameter_m) {
  GrainInput g;
  g.position_m = at;
  g.radius_m = 0.5 * diameter_m;
  return g;
}

// ---- case H ----------------------------------------------------------------------------------------------------------------------

/// 50 mm between frictional side walls x = +-25 mm, y periodic, floor |x| in [5, 25] mm without thickness at z = 0: a slot of 10 mm.
struct Hopper {
  double depth_m = 12e-3;  ///< periodic y; the deck's. The lattice has rows 1.3333 mm apart
  double time_step_s = 6e-6, fill_s = 0.222, discharge_s = 0.405;
  LawKind law = LawKind::hertz_mindlin_epsd;
  std::uint64_t seed = 1;
  int threads = 1;
};
struct HopperRun {
  double mass_kg = 0;                         ///< put in
  double solid_fraction = 0, top_m = 0;       ///< filled: fraction in 10 < z < 50 mm, highest centre
  double mean_speed_m_s = 0;                  ///< filled
  std::vector<double> time_s, discharged_kg;  ///< every 1.5 ms since opening: mass whose centre has gone below z = 0
  double discharged_at(double t) const {
    const double g = t / 1.5e-3;
    const std::size_t k = std::min(static_cast<std::size_t>(g), time_s.size() - 2);
    return discharged_kg[k] + (g - static_cast<double>(k)) * (discharged_kg[k + 1] - discharged_kg[k]);
  }
};

inline HopperRun run_hopper(const Hopper& h) {
  SimulationSetup s = setup(0.1, h.time_step_s, h.threads, h.law);
  s.box.low = Vec3(-25.5e-3, 0, -10e-3), s.box.high = Vec3(25.5e-3, h.depth_m, 160e-3);
  s.box.periodic[1] = true;
  Simulation sim(s);
  sim.add_wall(wall(PlaneShape{Vec3(-25e-3, 0, 0), Vec3::UnitX()}));
  sim.add_wall(wall(PlaneShape{Vec3(25e-3, 0, 0), -Vec3::UnitX()}));
  Wall plug = wall(PlaneShape{Vec3::Zero(), Vec3::UnitZ()});
  plug.present.off_s = h.fill_s;
  sim.add_wall(plug);
  MeshShape halves;
  for (const auto& [a, b] : {std::pair{-25e-3, -5e-3}, std::pair{5e-3, 25e-3}}) {
    // Beyond the box along y, so that no grain meets an edge at the periodic face.
    const double y0 = -5e-3, y1 = h.depth_m + 5e-3;
    halves.triangles.push_back({Vec3(a, y0, 0), Vec3(b, y0, 0), Vec3(b, y1, 0)});
    halves.triangles.push_back({Vec3(a, y0, 0), Vec3(b, y1, 0), Vec3(a, y1, 0)});
  }
  Wall floor = wall(halves);
  floor.present.on_s = h.fill_s;
  sim.add_wall(floor);

  // 25 / 50 / 25 % by mass of 0.8 / 1.0 / 1.2 mm on a jittered lattice 40 x rows x 125, sizes at random.
  const int nx = 40, ny = static_cast<int>(std::lround(h.depth_m / (4e-3 / 3))), nz = 125, n = nx * ny * nz;
  const double sizes[3] = {0.8e-3, 1.0e-3, 1.2e-3}, share[3] = {.25, .5, .25};
  double number[3], sum = 0;
  for (int k = 0; k < 3; ++k) sum += number[k] = share[k] / std::pow(sizes[k], 3);
  std::vector<double> diameter;
  for (int k = 0; k < 3; ++k) diameter.insert(diameter.end(), static_cast<std::size_t>(std::floor(number[k] / sum * n + 0.5)), sizes[k]);
  diameter.resize(static_cast<std::size_t>(n), sizes[1]);
  Rng shuffle(h.seed, stream_id("tests/peers/hopper/sizes"));
  for (std::size_t k = diameter.size() - 1; k > 0; --k) std::swap(diameter[k], diameter[shuffle.below(k + 1)]);
  Rng jitter(h.seed, stream_id("tests/peers/hopper/jitter"));
  std::size_t k = 0;
  for (int iz = 0; iz < nz; ++iz)
    for (int iy = 0; iy < ny; ++iy)
      for (int ix = 0; ix < nx; ++ix, ++k) {
        const Vec3 off((2 * jitter.uniform() - 1) * 2e-5, (2 * jitter.uniform() - 1) * 6e-5, (2 * jitter.uniform() - 1) * 1e-5);
        sim.add_grain(sphere(Vec3(-25e-3 + (ix + .5) * 50e-3 / nx, (iy + .5) * h.depth_m / ny, 0.65e-3 + iz * 1.22e-3) + off, diameter[k]));
      }

  HopperRun r;
  sim.step(std::llround(h.fill_s / h.time_step_s));
  double inside = 0;
  for (const GrainState& g : sim.grains()) {
    r.mass_kg += g.mass_kg;
    r.mean_speed_m_s += g.velocity_m_s.norm() / n;
    r.top_m = std::max(r.top_m, g.position_m.z());
    if (g.position_m.z() > 10e-3 && g.position_m.z() < 50e-3) inside += g.mass_kg / 2000;
  }
  r.solid_fraction = inside / (50e-3 * h.depth_m * 40e-3);
  double left = 0;
  const auto above = [&] {
    double mass = 0;
    for (const GrainState& g : sim.grains())
      if (g.position_m.z() > 0) mass += g.mass_kg;
    return mass;
  };
  left = above();
  r.time_s.push_back(0), r.discharged_kg.push_back(0);
  while (r.time_s.back() < h.discharge_s - 1e-9) {
    sim.step(std::llround(1.5e-3 / h.time_step_s));
    sim.remove_grains(sim.grains_outside(s.box));
    r.time_s.push_back(r.time_s.back() + 1.5e-3);
    r.discharged_kg.push_back(left - above());
  }
  return r;
}

/// Slope of the discharged mass between two times by least squares [kg/s].
inline double flow_kg_s(const HopperRun& r, double from_s, double to_s) {
  double n = 0, t = 0, m = 0, tt = 0, tm = 0;
  for (std::size_t k = 0; k < r.time_s.size(); ++k) {
    if (r.time_s[k] < from_s - 1e-9 || r.time_s[k] > to_s + 1e-9) continue;
    n += 1, t += r.time_s[k], m += r.discharged_kg[k], tt += r.time_s[k] * r.time_s[k], tm += r.time_s[k] * r.discharged_kg[k];
  }
  return (n * tm - t * m) / (n * tt - t * t);
}

// ---- case A ----------------------------------------------------------------------------------------------------------------------

/// 10,000 spheres of 1 mm in an open cylinder of 64 facets (corner radius 11 mm) that is lifted at 50 mm/s off a frictional floor.
struct Heap {
  double rolling_friction = 0.1;
  int grains = 10000;
  /// The deck's 1e-5 s is 26 % of the Rayleigh time. Ours: 20 %, since our damping (solved for the measured restitution) is stronger than the
  /// textbook's and such long steps keep a bed rattling.
  double time_step_s = 7.6e-6;
  LawKind law = LawKind::hertz_mindlin_epsd;
  std::uint64_t seed = 1;
  int threads = 1;
};
inline constexpr double kHeapFill_s = 0.15, kHeapLift_s = 0.45, kHeapRest_s = 0.15, kHeapDiameter_m = 1e-3, kCylinderRadius_m = 11e-3;

inline std::vector<GrainState> run_heap(const Heap& h) {
  Simulation sim(setup(h.rolling_friction, h.time_step_s, h.threads, h.law));
  sim.add_wall(wall(PlaneShape{}));
  const double pitch = 1.12e-3;
  const int m = static_cast<int>(kCylinderRadius_m / pitch) + 1;
  Rng jitter(h.seed, stream_id("tests/peers/heap/jitter"));
  int placed = 0, layer = 0;
  for (; placed < h.grains; ++layer)
    for (int ix = -m; ix <= m; ++ix)
      for (int iy = -m; iy <= m; ++iy) {
        const double x = (ix + .5 * (layer % 2)) * pitch, y = (iy + .5 * (layer % 2)) * pitch;
        if (std::hypot(x, y) >= kCylinderRadius_m * std::cos(std::numbers::pi / 64) - 0.57e-3 || placed >= h.grains) continue;
        const Vec3 off((2 * jitter.uniform() - 1) * 5e-5, (2 * jitter.uniform() - 1) * 5e-5, (2 * jitter.uniform() - 1) * 5e-5);
        sim.add_grain(sphere(Vec3(x, y, 0.6e-3 + layer * pitch) + off, kHeapDiameter_m));
        ++placed;
      }
  MeshShape cylinder;
  const double top = std::max(0.6e-3 + (layer - 1) * pitch + 2e-3, 30e-3);
  const auto corner = [&](int k, double z) {
    const double a = 2 * std::numbers::pi * k / 64;
    return Vec3(kCylinderRadius_m * std::cos(a), kCylinderRadius_m * std::sin(a), z);
  };
  for (int k = 0; k < 64; ++k) {
    cylinder.triangles.push_back({corner(k, 0), corner(k + 1, 0), corner(k + 1, top)});
    cylinder.triangles.push_back({corner(k, 0), corner(k + 1, top), corner(k, top)});
  }
  Wall lifted = wall(cylinder);
  lifted.motion.velocity_m_s = Vec3(0, 0, 0.05);
  lifted.motion.translate_when = {{kHeapFill_s, kHeapFill_s + kHeapLift_s}};
  sim.add_wall(lifted);
  sim.step(std::llround((kHeapFill_s + kHeapLift_s + kHeapRest_s) / h.time_step_s));
  return sim.grains();
}
}  // namespace venato::dem::peers
