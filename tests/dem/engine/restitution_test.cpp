/// Measured restitution = input, for pairs and walls (design.md 7; verification.md 1.3, 1.4, 2.1, 6.1).
#include <gtest/gtest.h>

#include "dem/contact/kernels/restitution.h"
#include "tests/dem/engine/scene.h"

namespace venato::dem {
namespace {
using namespace scene;

/// Table 1.3: textbook beta gives these clamped restitutions. They were computed by an independent integrator to 5 digits: 2e-5.
TEST(DampedHertz, ReproducesTheClampedColumn) {
  const double table[][3] = {{.98, .99156, .98008}, {.9, .97112, .90203}, {.7, .93046, .71820}, {.5, .89062, .55028},
                             {.3, .84607, .39714},  {.1, .78803, .25273}, {.05, .76716, .21370}};
  for (const auto& row : table) {
    const HertzCollision c = collide_hertz(std::sqrt(5.0) * textbook_damping(row[0]));
    EXPECT_NEAR(c.restitution, row[2], 2e-5) << "e = " << row[0];
    EXPECT_NEAR(c.duration_ratio, row[1], 1e-4) << "e = " << row[0];
  }
}
TEST(DampedHertz, InversionHitsTheTarget) {
  for (const double e : {1.0, 0.98, 0.8, 0.5, 0.25, 0.1, 0.02})  // 1e-6: the promise of the header
    EXPECT_NEAR(collide_hertz(std::sqrt(5.0) * damping_for_restitution(e)).restitution, e, 1e-6);
}

double pair_restitution(double e, double r1, double r2, double young, double v) {
  MaterialTable m = powder(e);
  m.materials[0].young_modulus_pa = young;
  const double m1 = 4.0 / 3 * std::numbers::pi * r1 * r1 * r1 * 1900, m2 = m1 * std::pow(r2 / r1, 3);
  const double t = hertz_time(m1 * m2 / (m1 + m2), r1 * r2 / (r1 + r2), young / (2 * (1 - 0.0625)), v);
  Simulation sim(setup(t / 2000, m));
  const GrainId a = sim.add_grain(grain(Vec3(0, 0, 0), r1, Vec3(v, 0, 0))), b = sim.add_grain(grain(Vec3(1.001 * (r1 + r2), 0, 0), r2));
  sim.step(static_cast<std::int64_t>((2 * t + 0.002 * (r1 + r2) / v) / (t / 2000)));
  return (sim.grain(b).velocity_m_s - sim.grain(a).velocity_m_s).x() / v;
}
/// 1e-3: 2000 steps per contact leave 3e-4 (5.2 of verification.md, first order).
TEST(Restitution, PairsEqualAndUnequal) {
  for (const double e : {1.0, 0.9, 0.5, 0.2}) {
    EXPECT_NEAR(pair_restitution(e, 2e-4, 2e-4, 1e7, 0.1), e, 1e-3);
    EXPECT_NEAR(pair_restitution(e, 8e-4, 1e-4, 1e8, 1.0), e, 1e-3);
  }
}
TEST(Restitution, WallAtRestAndMoving) {
  for (const double wall_speed : {0.0, 0.3, -0.2}) {
    const double e = 0.5, r = 2e-4, v = -0.4, m = 4.0 / 3 * std::numbers::pi * r * r * r * 1900,
                 t = hertz_time(m, r, 1e7 / (2 * (1 - 0.0625)), wall_speed - v);
    Simulation sim(setup(t / 2000));
    Wall w = plane();
    w.motion.velocity_m_s = Vec3(0, 0, wall_speed);
    sim.add_wall(w);
    const GrainId a = sim.add_grain(grain(Vec3(0, 0, r * 1.01), r, Vec3(0, 0, v)));
    sim.step(static_cast<std::int64_t>((2 * t + 0.01 * r / (wall_speed - v)) / (t / 2000)));
    EXPECT_NEAR(sim.grain(a).velocity_m_s.z(), wall_speed * (1 + e) - e * v, 1e-3);  // 6.1
  }
}

/// 1.4: forces of a frozen overlap, exact formulas: 1e-12 relative to the printed 7 digits means 1e-6 here, the formula itself 1e-12.
TEST(FrozenOverlap, PairForceAndReaction) {
  for (const double d : {1e-6, 4e-6}) {
    Simulation sim(setup(1e-7, {{{"grain", 2500, 1e7, 0.25}}, {{0.5, 0.5, 0, 0}}}));
    GrainInput a = grain(Vec3(0, 0, 0), 1e-3), b = grain(Vec3(0.6, 0.8, 0) * (2e-3 - d), 1e-3);
    a.frozen = b.frozen = true;
    sim.add_grain(a), sim.add_grain(b);
    sim.evaluate_forces();
    const ContactState c = sim.contacts().at(0);
    const double young = 1e7 / (2 * (1 - 0.0625)), expected = 4.0 / 3 * young * std::sqrt(5e-4) * std::pow(c.overlap_m, 1.5);
    EXPECT_NEAR(c.normal_force_n / expected, 1, 1e-12);
    EXPECT_NEAR(c.normal_force_n, d == 1e-6 ? 1.590093e-4 : 1.272074e-3, 1e-6 * c.normal_force_n + 1e-12);
    EXPECT_EQ(sim.grain(0).force_n, -sim.grain(1).force_n);  // bitwise opposite
  }
}
TEST(FrozenOverlap, DissimilarPairEitherOrder) {
  const MaterialTable m{{{"grain", 2500, 1e7, .25}, {"steel", 7800, 2.1e11, .3}},
                        {{.5, .5, .1, .3}, {.4, .3, .1, .3}, {.4, .3, .1, .3}, {.6, .5, .1, .3}}};
  Vec3 force[2];
  for (const int swap : {0, 1}) {
    Simulation sim(setup(1e-7, m));
    for (int k = 0; k < 2; ++k) {
      const bool steel = (k == 1) != (swap == 1);
      GrainInput g = grain(steel ? Vec3(1.4995e-3, 0, 0) : Vec3(0, 0, 0), steel ? 5e-4 : 1e-3);
      g.material = steel, g.frozen = true;
      sim.add_grain(g);
    }
    sim.evaluate_forces();
    force[swap] = sim.grain(swap).force_n;  // on the soft grain
  }
  EXPECT_EQ(force[0], force[1]);
  const double young = 1 / ((1 - .0625) / 1e7 + (1 - .09) / 2.1e11), r = 1e-3 * 5e-4 / 1.5e-3, d = 1e-3 + 5e-4 - 1.4995e-3;
  EXPECT_NEAR(force[0].x() / (-4.0 / 3 * young * std::sqrt(r) * std::pow(d, 1.5)), 1, 1e-9);  // d has 4 digits of cancellation
}
}  // namespace
}  // namespace venato::dem
