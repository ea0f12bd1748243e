/// Momentum, angular momentum, energy book, objectivity (verification.md 5).
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/dem/engine/scene.h"

namespace venato::dem {
namespace {
using namespace scene;

/// 100 unequal grains thrown together without gravity: rounding only. Scale = sum of the magnitudes.
TEST(Conservation, MomentumAndAngularMomentumOfACloud) {
  Simulation sim(setup(2e-6));
  Rng rng(5, 1);
  for (int k = 0; k < 100; ++k) {
    const Vec3 at(k % 5, k / 5 % 5, k / 25);
    const Vec3 v(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
    sim.add_grain(grain(at * 8.2e-4, 1e-4 + 3e-4 * rng.uniform(), v - 150 * (at * 8.2e-4 - Vec3(1.6e-3, 1.6e-3, 1.2e-3)), 300 * v));
  }
  auto sums = [&](double& scale_p, double& scale_l) {
    Vec3 p = Vec3::Zero(), l = Vec3::Zero();
    scale_p = scale_l = 0;
    for (const GrainState& g : sim.grains()) {
      const Vec3 spin = 0.4 * g.mass_kg * g.radius_m * g.radius_m * g.spin_rad_s, orbit = g.mass_kg * g.position_m.cross(g.velocity_m_s);
      p += g.mass_kg * g.velocity_m_s, l += spin + orbit;
      scale_p += g.mass_kg * g.velocity_m_s.norm(), scale_l += spin.norm() + orbit.norm();
    }
    return std::pair(p, l);
  };
  double sp, sl;
  const auto before = sums(sp, sl);
  const double energy_before = sim.energy().kinetic_j();
  double most = 0;
  for (int k = 0; k < 30; ++k) {
    sim.step(50);
    most = std::max(most, sim.statistics().contact_count);
  }
  const auto after = sums(sp, sl);
  EXPECT_GT(most, 5);  // they really met
  EXPECT_LT(sim.energy().kinetic_j(), 0.8 * energy_before);
  EXPECT_LT((after.first - before.first).norm(), 1e-12 * sp);
  EXPECT_LT((after.second - before.second).norm(), 1e-12 * sl);
}

/// Energy book over oblique impacts of unequal pairs and on walls: 1e-3 (verification.md 5.1) at 2000 steps per contact (first order in dt), every
/// loss >= 0.
TEST(Conservation, EnergyBookCloses) {
  for (const LawKind law : {LawKind::hertz_mindlin_epsd, LawKind::eepa})
    for (const bool with_wall : {false, true}) {
      SimulationSetup s = setup(2e-8, powder(0.6, 0.4, 0.1, 0.3));
      s.law = law;
      s.track_energy = true;
      s.gravity_m_s2 = Vec3(0, 0, -9.81);
      Simulation sim(s);
      if (with_wall) {
        Wall w = plane();
        w.motion.velocity_m_s = Vec3(0.05, 0, 0.1);
        sim.add_wall(w);
        sim.add_grain(grain(Vec3(0, 0, 2.02e-4), 2e-4, Vec3(0.1, 0.05, -0.2), Vec3(100, -300, 20)));
      } else {
        sim.add_grain(grain(Vec3(0, 0, 0), 2e-4, Vec3(0.3, 0, 0), Vec3(0, 200, 100)));
        sim.add_grain(grain(Vec3(3.9e-4, 3.2e-4, 0), 3e-4, Vec3(-0.2, 0, 0), Vec3(50, 0, -400)));
      }
      const EnergyBook a = sim.energy();
      const double start = a.kinetic_j() + a.potential_j;
      double worst = 0;
      bool touched = false;
      for (int k = 0; k < 60; ++k) {
        sim.step(125);
        const EnergyBook b = sim.energy();
        touched = touched || b.elastic_normal_j > 0;
        worst = std::max(worst, std::abs(b.kinetic_j() + b.potential_j + b.elastic_j() + b.dissipated_j() - b.wall_work_j - start));
      }
      const EnergyBook b = sim.energy();
      EXPECT_TRUE(touched);
      EXPECT_EQ(sim.contacts().size(), law == LawKind::eepa ? 1u : 0u);  // EEPA sticks at this speed
      EXPECT_LT(worst, 1e-3 * a.kinetic_j()) << "law " << static_cast<int>(law) << " wall " << with_wall;
      for (const double loss : {b.dissipated_normal_j, b.dissipated_tangential_damping_j, b.dissipated_sliding_j, b.dissipated_rolling_j})
        EXPECT_GE(loss, -1e-6 * a.kinetic_j());
      EXPECT_GT(b.dissipated_normal_j, 0.05 * a.kinetic_j());
    }
}

/// 5.6: a pressed and sheared pair turned as a rigid body keeps its tangential force and rolling torque, co-rotating. 1e-6 after 10 turns.
TEST(Objectivity, RigidlyTurnedContactKeepsItsSprings) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 2, 3).normalized()}) {
    const double dt = 1e-6, rate = 2 * std::numbers::pi / (2000 * dt);  // 2000 steps per turn
    Simulation sim(setup(dt, {{{"g", 2500, 1e7, .25}}, {{1.0, 0.8, 0.1, 0}}}));
    GrainInput g[2] = {grain(Vec3(-0.999e-3, 0, 0), 1e-3), grain(Vec3(0.999e-3, 0, 0), 1e-3)};
    for (auto& x : g) x.frozen = true, sim.add_grain(x);
    // shear and roll by hand, frozen: history only
    sim.set_velocity(0, Vec3(0, 2e-4 / (100 * dt) * 1e-3, 0), Vec3(0, 0, 0.2));
    sim.step(100);
    sim.set_velocity(0, Vec3::Zero(), Vec3::Zero());
    sim.step(1);
    const ContactState before = sim.contacts().at(0);
    ASSERT_GT(before.tangential_spring_n.norm(), 0);
    ASSERT_GT(before.rolling_spring_n_m.norm(), 0);
    const Vec3 middle = 0.5 * (sim.grain(0).position_m + sim.grain(1).position_m);
    const Vec3 arm[2] = {sim.grain(0).position_m - middle, sim.grain(1).position_m - middle};
    for (int k = 0; k < 20000; ++k) {
      // chords of the exact circle, so that positions stay rigid: v = (x(t + dt) - x(t)) / dt
      const Eigen::AngleAxisd now(rate * k * dt, axis), next(rate * (k + 1) * dt, axis);
      for (int i = 0; i < 2; ++i) sim.set_velocity(i, (next * arm[i] - now * arm[i]) / dt, 2 * std::tan(rate * dt / 2) / dt * axis);  // midpoint rule
      sim.step(1);
    }
    const ContactState after = sim.contacts().at(0);  // 10 whole turns: everything is back
    EXPECT_NEAR(after.tangential_spring_n.norm() / before.tangential_spring_n.norm(), 1, 1e-6);
    EXPECT_LT((after.tangential_spring_n - before.tangential_spring_n).norm(), 1e-6 * before.tangential_spring_n.norm());
    EXPECT_NEAR(after.rolling_spring_n_m.norm() / before.rolling_spring_n_m.norm(), 1, 1e-6);
  }
}

/// 5.5: shear at small overlap, press, unshear, release: never a gain. Springs follow the header: rescaled when the contact unloads.
TEST(Conservation, ElataBerrymanLoopGainsNothing) {
  const double dt = 1e-7;
  SimulationSetup s = setup(dt, {{{"g", 2500, 1e7, .25}}, {{1.0, 100, 0, 0}}});  // no slip
  s.track_energy = true;
  Simulation sim(s);
  GrainInput g[2] = {grain(Vec3(0, 0, 0), 1e-3), grain(Vec3(2e-3 - 1e-6, 0, 0), 1e-3)};
  for (auto& x : g) x.frozen = true, sim.add_grain(x);
  double work = 0;  // done on grain 1 by the hand that moves it
  auto move = [&](const Vec3& way) {
    const int n = 2000;
    sim.set_velocity(1, way / (n * dt), Vec3::Zero());
    for (int k = 0; k < n; ++k) {
      const Vec3 before = sim.grain(1).force_n;
      sim.step();
      work -= 0.5 * (before + sim.grain(1).force_n).dot(way / n);
    }
  };
  move(Vec3(0, 2e-7, 0)), move(Vec3(-3e-6, 0, 0)), move(Vec3(0, -2e-7, 0)), move(Vec3(3e-6, 0, 0));
  EXPECT_GT(work, -1e-3 * 4.08881e-12);  // a displacement history would hand out 4.08881e-12 J
  EXPECT_LT(work, 2 * 4.08881e-12);
}
}  // namespace
}  // namespace venato::dem
