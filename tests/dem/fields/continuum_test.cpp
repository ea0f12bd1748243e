// Coarse-grained fields: exact mass and momentum, stress of scenes with a known answer, and the balance of forces as an identity.
#include "dem/fields/continuum.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "dem/fields/cg_kernel.h"
#include "dem/fields/continuum_balance.h"
#include "tests/dem/engine/scene.h"

namespace venato::dem {
namespace {
constexpr double kRadius = 0.5e-3, kDiameter = 2 * kRadius;

Box box_of(const Vec3& low, const Vec3& high, bool px, bool py, bool pz) {
  Box b;
  b.low = low, b.high = high;
  b.periodic[0] = px, b.periodic[1] = py, b.periodic[2] = pz;
  return b;
}
/// Grains thrown into the box without regard to overlap: fields do not care.
std::vector<GrainState> cloud(int n, const Box& b, std::uint64_t seed) {
  std::vector<GrainState> grains;
  for (int k = 0; k < n; ++k) {
    Rng rng(seed, stream_id("tests/continuum/cloud"), static_cast<std::uint64_t>(k));
    const Vec3 none = Vec3::Zero();
    GrainState g{k, none, none, none, none, none, kRadius * (0.4 + rng.uniform()), 0, 0, 0, false};
    g.mass_kg = 2000 * 4.0 / 3 * std::numbers::pi * std::pow(g.radius_m, 3);
    for (int a = 0; a < 3; ++a) g.position_m[a] = b.low[a] + (b.high[a] - b.low[a]) * rng.uniform(), g.velocity_m_s[a] = rng.normal();
    if (k % 7 == 0) g.position_m.x() += 3 * (b.high.x() - b.low.x()) * (b.periodic[0] ? 1 : 0);  // unwrapped positions are wrapped
    grains.push_back(g);
  }
  return grains;
}
Vec3 sum(const std::vector<Vec3>& field, double volume) {
  Vec3 s = Vec3::Zero();
  for (const Vec3& v : field) s += volume * v;
  return s;
}
ContinuumFields fields_of(const ContinuumGrid& grid, const std::vector<GrainState>& grains, const std::vector<ContactState>& contacts = {}) {
  ContinuumSums sums(grid);
  sums.add(grains, contacts);
  return continuum_fields(sums);
}

TEST(Kernel, is_normalised_with_the_standard_deviation_that_it_is_named_after) {
  double total = 0, variance = 0;
  constexpr int n = 20000;
  for (int k = 0; k < n; ++k) {
    const double q = -1 + (k + 0.5) * 2 / n;
    total += kernel_density(q) * 2 / n;
    variance += q * q * kernel_density(q) * 2 / n;
    EXPECT_NEAR(kernel_integral(q), total - kernel_density(q) / n, 1e-7);  // midpoint rule with 20000 cells: error 1e-9
  }
  EXPECT_NEAR(total, 1, 1e-8);
  EXPECT_NEAR(std::sqrt(variance) * kKernelReach, 1, 1e-8);
}

// The integral of density and momentum over the grid is the total, whatever the cells and the width: below, at and above a grain's size.
TEST(Continuum, mass_and_momentum_are_exact_on_any_grid) {
  const Box boxes[] = {box_of(Vec3(-3e-3, 0, 1e-3), Vec3(3e-3, 5e-3, 7e-3), true, true, false),
                       box_of(Vec3::Zero(), Vec3(6e-3, 4e-3, 9e-3), false, false, false),
                       box_of(Vec3::Zero(), Vec3(4e-3, 4e-3, 4e-3), true, true, true)};
  for (const Box& b : boxes) {
    const auto grains = cloud(300, b, 5);
    double mass = 0;
    Vec3 momentum = Vec3::Zero();
    for (const GrainState& g : grains) mass += g.mass_kg, momentum += g.mass_kg * g.velocity_m_s;
    for (const double width : {0.1e-3, 0.5e-3, 2e-3})
      for (const Vec3& cell : {Vec3(0.4e-3, 0.7e-3, 0.55e-3), Vec3(1, 1, 0.3e-3), Vec3(1, 1, 1)}) {
        ContinuumSums sums(make_continuum_grid(b, cell, width));
        sums.add(grains, {});
        EXPECT_EQ(sums.mass_outside_kg(), 0);
        const ContinuumFields f = continuum_fields(sums);
        double total = 0;
        for (const double rho : f.density_kg_m3) total += rho * f.grid.cell_volume_m3();
        EXPECT_NEAR(total / mass, 1, 1e-12) << width << " " << cell.transpose();
        EXPECT_NEAR((sum(f.momentum_kg_m2_s, f.grid.cell_volume_m3()) - momentum).norm() / momentum.norm(), 0, 1e-12);
      }
  }
}

// Grains that move in a straight line: density at two times differs by the flux through the faces in between (mass balance, cell by cell). The flux
// of the moving point over a cell's face, integrated over the time, is the line integral on faces.
TEST(Continuum, mass_balance_holds_in_every_cell) {
  const Box b = box_of(Vec3::Zero(), Vec3(4e-3, 4e-3, 4e-3), true, true, false);
  const ContinuumGrid grid = make_continuum_grid(b, Vec3(0.5e-3, 0.8e-3, 0.4e-3), 0.5e-3);
  std::vector<GrainState> grains = cloud(30, b, 8);
  for (GrainState& g : grains) g.position_m.z() = 1e-3 + 0.5 * g.position_m.z();
  const ContinuumFields before = fields_of(grid, grains);
  // A "contact" whose force is (m, 0, 0) and whose branch is the way gone: its virial on faces is the mass transport.
  std::vector<ContactState> ways;
  std::vector<GrainState> later = grains;
  const double dt = 1e-4;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    later[k].position_m += dt * grains[k].velocity_m_s;
    const Vec3 none = Vec3::Zero();
    ContactState c{grains[k].id, -1, 0, 0, none, 0, none, none, none, none, none, none};
    c.normal = grains[k].velocity_m_s.normalized();
    c.overlap_m = grains[k].radius_m - dt * grains[k].velocity_m_s.norm();  // contact point = the later place
    c.force_n = Vec3(grains[k].mass_kg, 0, 0);
    ways.push_back(c);
  }
  const ContinuumFields after = fields_of(grid, later);
  const MomentumBalance flux = momentum_balance(grid, grains, ways, Vec3::Zero());
  // div of -m (r - r') int phi = m phi(r) - m phi(r')
  double largest = 0;
  for (std::size_t c = 0; c < grid.size(); ++c) largest = std::max(largest, std::abs(after.density_kg_m3[c] - before.density_kg_m3[c]));
  ASSERT_GT(largest, 10);
  for (std::size_t c = 0; c < grid.size(); ++c)
    EXPECT_NEAR(after.density_kg_m3[c] - before.density_kg_m3[c], -flux.divergence[c].x(), 1e-12 * largest);
}

// Two grains pressed together in a box averaged over x and y: sigma_zz(z) = -F / A int_0^1 phi(z - z1 - s b) b ds = -F / A [Phi(z - z1) - Phi(z -
// z2)].
TEST(Continuum, pressed_pair_gives_the_analytic_stress) {
  auto setup = scene::setup(1e-6);
  Simulation sim(setup);
  const double d = 1.96 * kRadius;
  sim.add_grain(scene::grain(Vec3(2e-3, 2e-3, 3e-3), kRadius));
  sim.add_grain(scene::grain(Vec3(2e-3, 2e-3, 3e-3 + d), kRadius));
  sim.evaluate_forces();
  const auto contacts = sim.contacts();
  ASSERT_EQ(contacts.size(), 1u);
  const double force = contacts[0].normal_force_n, area = 16e-6;
  const Box b = box_of(Vec3::Zero(), Vec3(4e-3, 4e-3, 7e-3), true, true, false);
  for (const double width : {0.1e-3, 0.5e-3, 1e-3}) {
    const ContinuumGrid grid = make_continuum_grid(b, Vec3(1, 1, 0.25e-3), width);
    const ContinuumFields f = fields_of(grid, sim.grains(), contacts);
    double total = 0;
    for (int k = 0; k < grid.n[2]; ++k) {
      constexpr int n = 2000;
      double mean = 0;  // over the cell, by the midpoint rule: error < 1e-6 of the largest value
      for (int p = 0; p < n; ++p) {
        const double z = grid.low.z() + (k + (p + 0.5) / n) * grid.cell_m.z(), c = kKernelReach * width;
        mean += (kernel_integral((z - 3e-3) / c) - kernel_integral((z - 3e-3 - d) / c)) / n;
      }
      EXPECT_NEAR(f.contact_stress_pa[grid.index(0, 0, k)][8], -force / area * mean, 1e-6 * force / area);
      for (const std::size_t other : {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u}) EXPECT_EQ(f.contact_stress_pa[grid.index(0, 0, k)][other], 0);
      total += f.contact_stress_pa[grid.index(0, 0, k)][8] * grid.cell_volume_m3();
    }
    EXPECT_NEAR(total / (-force * d), 1, 1e-12);  // Love-Weber: the integral is the virial
  }
}

// verification.md 7.2(e): simple-cubic block strained by eps: stress = E eps^1.5 / (3 (1 - nu^2)) = 112.44 Pa for any grain
// size, per area before straining; the field is per area as it is, (1 - eps)^2 of that. 1e-4: the five digits of the number.
TEST(Continuum, simple_cubic_block_has_the_stress_of_its_strain) {
  for (const double cg : {1.0, 3.0}) {
    const double eps = 1e-3, pitch = cg * kDiameter * (1 - eps);
    auto setup = scene::setup(1e-6);
    setup.box = box_of(Vec3::Zero(), Vec3(6 * pitch, 6 * pitch, 6 * pitch), true, true, true);
    Simulation sim(setup);
    for (int k = 0; k < 216; ++k) sim.add_grain(scene::grain(pitch * Vec3(k % 6 + 0.3, k / 6 % 6 + 0.5, k / 36 + 0.1), cg * kRadius));
    sim.evaluate_forces();
    ASSERT_EQ(sim.contacts().size(), 648u);
    const ContinuumFields f = fields_of(make_continuum_grid(setup.box, Vec3::Constant(0.7 * pitch), pitch), sim.grains(), sim.contacts());
    double mean = 0;
    for (std::size_t c = 0; c < f.grid.size(); ++c) {
      mean += f.pressure_pa(c) / static_cast<double>(f.grid.size());
      for (const std::size_t diagonal : {0u, 4u, 8u}) EXPECT_NEAR(f.contact_stress_pa[c][diagonal], -112.44, 1);  // w = d: 1 % of lattice ripple
      for (const std::size_t shear : {1u, 2u, 3u, 5u, 6u, 7u}) EXPECT_NEAR(f.contact_stress_pa[c][shear], 0, 1e-9);
    }
    EXPECT_NEAR(mean * (1 - eps) * (1 - eps), 112.44, 0.01) << "cg " << cg;
  }
}

// Affine motion has no granular temperature and gives its gradient; the kinetic stress keeps it (it must: the balance is about V of the cell).
TEST(Continuum, rigid_rotation_has_no_temperature_after_the_gradient_term) {
  const Box b = box_of(Vec3::Zero(), Vec3(6e-3, 6e-3, 6e-3), false, false, false);
  auto grains = cloud(600, b, 3);
  const Vec3 spin(20, -30, 50), centre(1e-3, 2e-3, 3e-3);
  for (GrainState& g : grains) g.velocity_m_s = Vec3(0.1, 0.2, -0.3) + spin.cross(g.position_m - centre);
  const double width = 0.8e-3, scale = spin.squaredNorm() * width * width;
  const ContinuumFields f = fields_of(make_continuum_grid(b, Vec3::Constant(0.75e-3), width), grains);
  int seen = 0;
  for (std::size_t c = 0; c < f.grid.size(); ++c) {
    if (!(f.grains[c] > 8)) continue;
    ++seen;
    EXPECT_NEAR(f.temperature_m2_s2[c] / scale, 0, 1e-10);  // cancellation of v^2 ~ 0.1 against scale ~ 1e-3, times rounding, times 1e4 of room
    const auto& g = f.gradient_1_s[c];
    const double curl[3] = {g[7] - g[5], g[2] - g[6], g[3] - g[1]};
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(curl[k], 2 * spin[k], 1e-6 * spin.norm());
    // v'^2 / 3 about V is the spread of spin x r: about 2/3 w^2 spin^2 of the kernel plus the cell's. Not zero, so the subtraction does work.
    const auto& s = f.kinetic_stress_pa[c];
    EXPECT_GT(-(s[0] + s[4] + s[8]) / 3 / f.density_kg_m3[c], 0.1 * scale);
  }
  EXPECT_GT(seen, 300);
}

// A gas with independent normal velocities in a shear flow: its temperature, the shear rate and the kinetic pressure come back.
TEST(Continuum, a_sheared_gas_gives_back_its_temperature_and_shear_rate) {
  const Box b = box_of(Vec3::Zero(), Vec3(10e-3, 10e-3, 10e-3), true, true, false);
  const double sigma = 0.05, shear = 40;
  ContinuumSums sums(make_continuum_grid(b, Vec3(1, 1, 1e-3), 1e-3));
  for (std::uint64_t frame = 0; frame < 20; ++frame) {
    auto grains = cloud(3000, b, 100 + frame);
    for (GrainState& g : grains) g.velocity_m_s = sigma * g.velocity_m_s + Vec3(0, shear * g.position_m.z(), 0);
    sums.add(grains, {});
  }
  const ContinuumFields f = continuum_fields(sums);
  for (int k = 0; k < f.grid.n[2]; ++k) {
    const double z = f.grid.centre_m(2, k);
    if (z < 3e-3 || z > 7e-3) continue;
    const std::size_t c = f.grid.index(0, 0, k);
    // About 10^4 independent grain-frames per kernel: 3 sigma of T = 3 sqrt(2 / (3 n)) = 2.5 %; of the gradient 3 sigma / (w sqrt(n)) = 1.5 / s.
    EXPECT_NEAR(f.temperature_m2_s2[c] / (sigma * sigma), 1, 0.025) << z;
    EXPECT_NEAR(f.gradient_1_s[c][5], shear, 1.5) << z;  // d v_y / d z
    EXPECT_NEAR(f.velocity_m_s[c].y(), shear * z, 3 * sigma / 100);
    EXPECT_NEAR(-f.kinetic_stress_pa[c][0] / f.density_kg_m3[c] / (sigma * sigma), 1, 0.05);  // xx: no gradient in it
  }
}

/// A poured bed on a plane with a mesh ramp and a frozen grain in it.
Simulation bed(int steps) {
  auto setup = scene::setup(3e-6);
  Simulation sim = scene::heap(500, setup);
  auto frozen = scene::grain(Vec3(1.2e-3, 3.1e-3, 0.3e-3), 0.35e-3);
  frozen.frozen = true;
  sim.add_grain(frozen);
  sim.step(steps);
  return sim;
}
Box heap_box(const Simulation& sim) {  // scene::heap: side * pitch, periodic in x and y
  const int side = std::max(3, static_cast<int>(std::cbrt(500 / 2.0)));
  const double w = side * 2.05 * 400e-6;
  double top = 0;
  for (const GrainState& g : sim.grains()) top = std::max(top, g.position_m.z());
  return box_of(Vec3(0, 0, -1e-4), Vec3(w, w, top + 1e-4), true, true, false);
}

// The identity behind the fields, in a bed that is still falling, with walls, a mesh and a frozen grain. Rounding: sums of some 100 terms per cell.
TEST(Balance, forces_of_every_cell_add_up) {
  Simulation sim = bed(6000);
  const auto grains = sim.grains();
  const auto contacts = sim.contacts();
  ASSERT_GT(contacts.size(), 200u);
  const Vec3 gravity(0, 0, -9.81);
  for (const double width : {0.15e-3, 0.4e-3, 1.2e-3}) {
    const ContinuumGrid grid = make_continuum_grid(heap_box(sim), Vec3(0.5e-3, 0.62e-3, 0.45e-3), width);
    const MomentumBalance b = momentum_balance(grid, grains, contacts, gravity);
    EXPECT_LT(b.largest_residual / b.largest_term, 1e-11) << width;
    // Over the whole box: d(momentum)/dt = weight + walls; the stress sends nothing out.
    Vec3 force = Vec3::Zero(), walls = Vec3::Zero(), weight = Vec3::Zero();
    for (const GrainState& g : grains) {
      if (g.frozen) continue;
      force += g.force_n, weight += g.mass_kg * gravity;
    }
    for (const Vec3& w : b.wall) walls += grid.cell_volume_m3() * w;
    EXPECT_LT(sum(b.divergence, grid.cell_volume_m3()).norm(), 1e-11 * weight.norm());
    EXPECT_LT((force - walls - weight).norm(), 1e-11 * weight.norm());
    // Control: without the boundary's term, or with the stress of half the contacts, nothing adds up.
    const std::vector<ContactState> half(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(contacts.size() / 2));
    const MomentumBalance wrong = momentum_balance(grid, grains, half, gravity);
    EXPECT_GT(wrong.largest_residual / wrong.largest_term, 0.1);
  }
}

// d(momentum)/dt by differences of the fields: what the step changes is the mean of the forces at its two ends (velocity Verlet).
TEST(Balance, momentum_changes_as_the_fields_say) {
  Simulation sim = bed(6000);
  const Vec3 gravity(0, 0, -9.81);
  const ContinuumGrid grid = make_continuum_grid(heap_box(sim), Vec3(1, 1, 0.5e-3), 0.5e-3);
  const auto total = [&](Vec3& momentum) {
    const ContinuumFields f = fields_of(grid, sim.grains(), sim.contacts());
    momentum = sum(f.momentum_kg_m2_s, grid.cell_volume_m3());
    double mass = 0;
    for (const double rho : f.density_kg_m3) mass += grid.cell_volume_m3() * rho;
    return Vec3(sum(f.wall_force_n_m3, grid.cell_volume_m3()) + mass * gravity);
  };
  Vec3 before, after;
  const Vec3 force_before = total(before);
  sim.step();
  const Vec3 force_after = total(after);
  const Vec3 rate = (after - before) / sim.time_step_s(), force = 0.5 * (force_before + force_after);
  ASSERT_GT(force.norm(), 1e-6);
  EXPECT_LT((rate - force).norm() / force.norm(), 1e-7);  // rounding of the momentum (1e-16) over what one step changes of it
}

// A column at rest: div sigma + rho g + t = 0 to rounding (the forces on its grains have died down to 1e-14 of their weight), and the floor carries
// the weight.
TEST(Balance, a_column_at_rest_is_in_equilibrium) {
  auto setup = scene::setup(5e-6, scene::powder(0.2, 0.5, 0.1), Vec3(0, 0, -9.81));
  setup.box = box_of(Vec3::Zero(), Vec3(2.5e-3, 2.5e-3, 1), true, true, false);
  Simulation sim(setup);
  sim.add_wall(scene::plane());
  for (int k = 0; k < 36; ++k) {
    Rng rng(4, stream_id("tests/continuum/column"), static_cast<std::uint64_t>(k));
    sim.add_grain(scene::grain(
        Vec3(0.7e-3 + 1.2e-3 * (k % 2) + 1e-4 * rng.uniform(), 0.7e-3 + 1.2e-3 * (k / 2 % 2) + 1e-4 * rng.uniform(), (0.6 + 1.1 * (k / 4)) * 1e-3),
        kRadius));
  }
  sim.step(160000);
  const auto grains = sim.grains();
  double mass = 0, restless = 0;
  for (const GrainState& g : grains) mass += g.mass_kg, restless = std::max(restless, g.force_n.norm() / (g.mass_kg * 9.81));
  ASSERT_LT(restless, 1e-12);
  const Vec3 gravity(0, 0, -9.81);
  const ContinuumGrid grid = make_continuum_grid(box_of(Vec3(0, 0, 0), Vec3(2.5e-3, 2.5e-3, 12e-3), true, true, false), Vec3(1, 1, 0.5e-3), 0.7e-3);
  const MomentumBalance b = momentum_balance(grid, grains, sim.contacts(), gravity);
  for (std::size_t c = 0; c < grid.size(); ++c) EXPECT_LT((b.divergence[c] + b.weight[c] + b.wall[c]).norm(), 1e-11 * b.largest_term);
  EXPECT_LT(b.largest_residual, 1e-12 * b.largest_term);
  const ContinuumFields f = fields_of(grid, grains, sim.contacts());
  EXPECT_NEAR(sum(f.wall_force_n_m3, grid.cell_volume_m3()).z() / (mass * 9.81), 1, 1e-11);
  // Weight above a height = vertical stress there (sigma_zz on cells, so to the second order in the cell: compare in the middle of the column).
  const std::size_t middle = grid.index(0, 0, grid.n[2] / 3);
  double above = 0;
  for (std::size_t c = middle; c < grid.size(); ++c) above += (c == middle ? 0.5 : 1.0) * f.density_kg_m3[c] * 9.81 * grid.cell_m.z();
  EXPECT_NEAR(-f.contact_stress_pa[middle][8] / above, 1, 0.02);
}

TEST(Continuum, bad_grids_and_no_frames_are_refused) {
  const Box b = box_of(Vec3::Zero(), Vec3(1, 1, 1), false, false, false);
  EXPECT_THROW(make_continuum_grid(b, Vec3(0.1, 0.1, 0.1), 0), UsageError);
  EXPECT_THROW(make_continuum_grid(b, Vec3(0.1, 0, 0.1), 0.1), UsageError);
  EXPECT_THROW(make_continuum_grid(b, Vec3(0.1, 0.1, std::nan("")), 0.1), UsageError);
  EXPECT_THROW(continuum_fields(ContinuumSums(make_continuum_grid(b, Vec3(1, 1, 1), 0.1))), UsageError);
}
}  // namespace
}  // namespace venato::dem
