/// Forces, stiffnesses and torques of contacts held still and moved by hand: exact formulas, swapped order, closed loops of faulty springs.
#include <gtest/gtest.h>

#include <array>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
const Ball kBead{1e7, .25, 2500, 1e-3};
const MaterialTable kGrainAndSteel{{{"grain", 2500, 1e7, .25}, {"steel", 7800, 2.1e11, .3}},
                                   {{.5, 100, .1, .3}, {.4, 100, .1, .3}, {.4, 100, .1, .3}, {.6, 100, .1, .3}}};

/// 1/Y* = sum (1 - nu^2) / E and 1/G* = sum 2 (2 - nu)(1 + nu) / E: rounding, 1e-14. The control takes the mean of the two shear moduli (as some
/// codes do): 1.5e4 times too stiff for a soft grain on steel, far outside.
TEST(Moduli, AreTheMindlinSums) {
  const EffectiveModuli same = effective_moduli(kBead.material(), kBead.material());
  EXPECT_NEAR(same.young_pa / 5333333.3333333333, 1, 1e-14);
  EXPECT_NEAR(same.shear_pa / 1142857.1428571429, 1, 1e-14);
  const auto& m = kGrainAndSteel.materials;
  const EffectiveModuli mixed = effective_moduli(m[0], m[1]), back = effective_moduli(m[1], m[0]);
  const double young = 1 / (.9375 / 1e7 + .91 / 2.1e11), shear = 1 / (2 * 1.75 * 1.25 / 1e7 + 2 * 1.7 * 1.3 / 2.1e11);
  auto is = [](double value, double expected) { return std::abs(value / expected - 1) <= 1e-14; };
  EXPECT_TRUE(is(mixed.young_pa, young));
  EXPECT_TRUE(is(mixed.shear_pa, shear));
  EXPECT_EQ(mixed.young_pa, back.young_pa);
  EXPECT_EQ(mixed.shear_pa, back.shear_pa);
  EXPECT_FALSE(is(.5 * (1e7 / 2.5 + 2.1e11 / 2.6), shear));
}

struct Held {
  ContactState contact;      ///< seen from grain 0
  Vec3 force[2], torque[2];  ///< on the soft grain and on the other
};
/// A pair held at an overlap, sheared and rolled by hand: `swap` names the second one first. No slip (mu = 100), no rolling slip (tiny angles).
Held held(const MaterialTable& table, const std::array<int, 2>& material, const std::array<double, 2>& radius, double overlap, const Vec3& shear,
          const Vec3& roll, bool swap, double dt = 1e-7) {
  Simulation sim(scene::setup(dt, table));
  const Vec3 axis = Vec3(.36, .48, .8);
  for (const int k : {swap ? 1 : 0, swap ? 0 : 1}) {
    GrainInput g = scene::grain(k == 0 ? Vec3(0, 0, 0) : Vec3(axis * (radius[0] + radius[1] - overlap)), radius[static_cast<std::size_t>(k)]);
    g.material = material[static_cast<std::size_t>(k)], g.frozen = true;
    sim.add_grain(g);
  }
  const GrainId first = swap ? 1 : 0, second = 1 - first;
  sim.evaluate_forces();
  if (shear.norm() + roll.norm() > 0) {
    const double steps = 100;
    sim.set_velocity(first, -shear / (2 * steps * dt), roll / (steps * dt)), sim.set_velocity(second, shear / (2 * steps * dt), Vec3::Zero());
    sim.step(100);
    sim.set_velocity(first, Vec3::Zero(), Vec3::Zero()), sim.set_velocity(second, Vec3::Zero(), Vec3::Zero());
    sim.step(1);
  }
  return {sim.contacts().at(0), {sim.grain(first).force_n, sim.grain(second).force_n}, {sim.grain(first).torque_n_m, sim.grain(second).torque_n_m}};
}
/// k_t = 8 G* sqrt(R* d): 204.4405 and 408.8810 N/m (7 digits printed: 1e-6, as the shear turns the normal by 1e-5 only), and the formula for a soft
/// grain on steel of half the size. F_t = k_t s, no slip.
TEST(FrozenOverlap, TangentialStiffness) {
  const Vec3 along = Vec3(.36, .48, .8).cross(Vec3(1, 0, 0)).normalized() * 1e-10;
  const double printed[][2] = {{1e-6, 204.4405}, {4e-6, 408.8810}};
  for (const auto& row : printed) {
    const Held h = held(kGrainAndSteel, {0, 0}, {1e-3, 1e-3}, row[0], along, Vec3::Zero(), false);
    EXPECT_NEAR(h.contact.tangential_force_n.norm() / 1e-10 / row[1], 1, 1e-6) << row[0];
    EXPECT_NEAR(h.contact.normal_force_n / (4. / 3 * 16 / 3e-6 * std::sqrt(5e-4) * std::pow(h.contact.overlap_m, 1.5)), 1, 1e-12);
  }
  const Held mixed = held(kGrainAndSteel, {0, 1}, {1e-3, 5e-4}, 1e-6, along, Vec3::Zero(), false);
  const double shear = effective_moduli(kGrainAndSteel.materials[0], kGrainAndSteel.materials[1]).shear_pa;
  EXPECT_NEAR(mixed.contact.tangential_force_n.norm() / (1e-10 * 8 * shear * std::sqrt(1e-3 / 3 * mixed.contact.overlap_m)), 1, 1e-6);
}
/// The order of the two grains is only a name: forces and torques bit for bit, with both springs loaded; the springs in the books change sign, each
/// (the tangential one as a force on i, the rolling one as a torque on i). A rolling spring with the wrong sign would be wrong by its whole size.
TEST(FrozenOverlap, SwappedOrderBitwise) {
  const Vec3 n(.36, .48, .8), along = n.cross(Vec3(1, 0, 0)).normalized() * 1e-9, roll = n.cross(Vec3(0, 1, 0)).normalized() * 1e-5;
  for (const std::array<int, 2>& material : {std::array{0, 0}, std::array{0, 1}}) {
    const Held a = held(kGrainAndSteel, material, {1e-3, 5e-4}, 1e-6, along, roll, false),
               b = held(kGrainAndSteel, material, {1e-3, 5e-4}, 1e-6, along, roll, true);
    for (const int k : {0, 1}) {
      EXPECT_EQ(a.force[k], b.force[k]) << k;
      EXPECT_EQ(a.torque[k], b.torque[k]) << k;
    }
    EXPECT_EQ(a.force[0], -a.force[1]);
    EXPECT_EQ(a.contact.tangential_spring_n, -b.contact.tangential_spring_n);
    EXPECT_EQ(a.contact.rolling_spring_n_m, -b.contact.rolling_spring_n_m);
    EXPECT_GT(a.contact.tangential_spring_n.norm(), 1e-8);
    EXPECT_GT(a.contact.rolling_spring_n_m.norm(), 1e-14);
  }
}

/// Work of the hand over the four sides of the Elata-Berryman loop by the bare formulas; `rescale`: the spring shrinks on unloading; `displacement`:
/// it is k_t(d) times the displacement.
double loop_work(bool shear_first, bool rescale, bool displacement) {
  const double g = 8 * 1.142857142857e6, r = 5e-4, low = 1e-6, high = 4e-6, s = 2e-7;
  const int n = 2000;
  double work = 0, overlap = low, spring = 0, xi = 0;
  auto go = [&](double shear, double press) {
    for (int k = 0; k < n; ++k) {
      const double before = displacement ? g * std::sqrt(r * overlap) * xi : spring;
      const double was = std::sqrt(r * overlap), now = std::sqrt(r * (overlap += press / n));
      if (rescale && now < was) spring *= now / was;
      spring += g * now * shear / n, xi += shear / n;
      work += .5 * (before + (displacement ? g * now * xi : spring)) * shear / n;
    }
  };
  const double press = high - low;
  if (shear_first)
    go(s, 0), go(0, press), go(-s, 0), go(0, -press);
  else
    go(0, press), go(s, 0), go(0, -press), go(-s, 0);
  return work;
}
/// "Never a gain, in either sense" is the check that conservation_test.cpp puts to the engine (1e-3 of W). The same check rejects the displacement
/// spring in one sense and the incremental spring that does not shrink in the other: each hands out W = 4.08881e-12 J (1e-3).
TEST(ClosedLoop, FaultySpringsAreRejected) {
  constexpr double kW = 4.08881e-12;
  auto never_gains = [](double first, double second) { return first >= -1e-3 * kW && second >= -1e-3 * kW; };
  EXPECT_TRUE(never_gains(loop_work(true, true, false), loop_work(false, true, false)));
  EXPECT_FALSE(never_gains(loop_work(true, false, true), loop_work(false, false, true)));
  EXPECT_FALSE(never_gains(loop_work(true, false, false), loop_work(false, false, false)));
  EXPECT_NEAR(loop_work(true, false, true) / -kW, 1, 1e-3);
  EXPECT_NEAR(loop_work(false, false, false) / -kW, 1, 1e-3);
  EXPECT_NEAR(loop_work(true, true, false) / kW, 1, 1e-3);  // what the engine keeps
  EXPECT_NEAR(loop_work(false, true, false) / kW, 1, 1e-3);
}
}  // namespace
}  // namespace venato::dem::verification
