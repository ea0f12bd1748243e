// The comparison law has the formulas of the other code, faults included; each fault is shown against a closed form, with our own law beside it.
#include "dem/contact/liggghts_hertz/law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "dem/contact/hertz_mindlin/law.h"

namespace venato::dem {
namespace {
MaterialTable table(double young, double poisson, double density, const PairProperties& p) { return {{{"ball", density, young, poisson}}, {p}}; }

/// Contact of two equal spheres (or, with m_eff = m and r_eff = R, of one with a wall) with normal x.
ContactGeometry contact(double overlap, double r_eff, double m_eff) {
  ContactGeometry g{};
  g.overlap = g.overlap_before = overlap;
  g.normal = Trio(1, 0, 0);
  g.turn = frame_turn(g.normal, g.normal, 0);
  g.r_eff = r_eff, g.m_eff = m_eff, g.i_roll = 1;
  return g;
}

/// The frame has turned from the direction `before` to g.normal by the shortest way.
void turn_from(ContactGeometry& g, const Trio& before) { g.turn = frame_turn((1 / length(before)) * before, g.normal, 0); }

// verification.md 1.4 and 1.1: forces at a frozen overlap.
TEST(LiggghtsHertz, has_the_common_stiffness) {
  const LiggghtsHertz law = make_liggghts_hertz(table(1e7, .25, 2500, {1, 10, 0, 0}), 0, 0);
  for (const auto& [overlap, k_t, force] : {std::tuple{1e-6, 204.4405, 1.590093e-4}, std::tuple{4e-6, 408.8810, 1.272074e-3}}) {
    ContactGeometry g = contact(overlap, 0.5e-3, 1);
    g.slide = Trio(0, 1e-3, 0);
    ContactHistory h{};
    const ContactForce f = law.force(g, h, 1e-6);
    EXPECT_NEAR(f.normal / force, 1, 1e-6);  // seven digits are given
    EXPECT_NEAR(f.tangential.y / (-k_t * 1e-9), 1, 1e-6);
    EXPECT_EQ(f.rolling.y, 0);
  }
}

/// Free collision of two equal spheres in the plane z = 0 with spins about z; lever R - overlap / 2 on both, which both codes have. Velocity Verlet.
struct Pair {
  double radius = .1, mass = 4.0 / 3 * std::numbers::pi * 1e-3 * 2700;
  Trio x[2] = {{-.1, 0, 0}, {.1, 0, 0}}, v[2];
  double w[2] = {0, 0};
  double tangential_impulse = 0, most_pull = 0;
};
template <class L>
void collide(const L& law, Pair& p, double dt) {
  ContactHistory h{};
  for (int k = 0; k < 10'000'000; ++k) {
    for (int a : {0, 1}) p.x[a] = p.x[a] + dt * p.v[a];
    const Trio to = p.x[1] - p.x[0];
    const double distance = length(to), overlap = 2 * p.radius - distance;
    if (overlap <= 0) {
      ASSERT_GT(k, 1000);
      return;
    }
    const Trio n = (1 / distance) * to, dv = p.v[1] - p.v[0];
    const double arm = p.radius - overlap / 2;
    ContactGeometry g = contact(overlap, p.radius / 2, p.mass / 2);
    g.normal = n;
    g.approach = -dot(dv, n);
    g.slide = cross(arm * (p.w[0] + p.w[1]) * Trio(0, 0, 1), n) - across(dv, n);
    const Trio before = to - dt * dv;
    turn_from(g, before);
    g.overlap_before = std::max(0.0, 2 * p.radius - length(before));
    const ContactForce f = law.force(g, h, dt);
    p.most_pull = std::max(p.most_pull, -f.normal);
    p.tangential_impulse += length(f.tangential) * dt;
    const Trio on_0 = f.tangential - f.normal * n;
    p.v[0] = p.v[0] + (dt / p.mass) * on_0;
    p.v[1] = p.v[1] - (dt / p.mass) * on_0;
    const double spin = arm * cross(n, f.tangential).z * dt / (0.4 * p.mass * p.radius * p.radius);
    for (int a : {0, 1}) p.w[a] += spin;
  }
  FAIL() << "never parted";
}
PairProperties aluminium(double restitution, double friction) { return {restitution, friction, 0, 0}; }

// Not limited: e is the input (verification.md 1.3, unclamped); ours reaches it with another damping factor. 2e-4: step.
TEST(LiggghtsHertz, rebounds_with_the_input_restitution_and_pulls) {
  for (const double e : {.9, .5, .2}) {
    Pair p;
    p.v[0] = Trio(.2, 0, 0), p.v[1] = Trio(-.2, 0, 0);
    collide(make_liggghts_hertz(table(7e10, .33, 2700, aluminium(e, 0)), 0, 0), p, 1e-7);
    EXPECT_NEAR(-p.v[0].x / .2, e, 2e-4);
    EXPECT_GT(p.most_pull, 1);  // N, of some thousands at the peak
    Pair q;
    q.v[0] = Trio(.2, 0, 0), q.v[1] = Trio(-.2, 0, 0);
    collide(make_hertz_mindlin(table(7e10, .33, 2700, aluminium(e, 0)), 0, 0), q, 1e-7);
    EXPECT_EQ(q.most_pull, 0);
  }
}

// verification.md 3.7: same-sense spins, gross sliding all through. Coulomb asks |d v_t| = mu d v_n; the uncapped damping gives 1.172 of it.
TEST(LiggghtsHertz, sliding_impulse_is_seventeen_percent_above_coulomb) {
  const auto ratio = [](const auto& law) {
    Pair p;
    p.v[0] = Trio(.2, 0, 0), p.v[1] = Trio(-.2, 0, 0);
    p.w[0] = p.w[1] = 10;
    collide(law, p, 1e-7);
    return std::abs(p.v[0].y) / (.4 * std::abs(p.v[0].x - .2));
  };
  const MaterialTable t = table(7e10, .33, 2700, aluminium(.5, .4));
  EXPECT_NEAR(ratio(make_liggghts_hertz(t, 0, 0)), 1.172, .002);
  EXPECT_NEAR(ratio(make_hertz_mindlin(t, 0, 0)), 1, .002);
}

/// Work that a contact does in the closed loop of verification.md 5.5: shear at d1, press to d2, shear back, release. No slip, no damping.
template <class L>
double loop_work(const L& law) {
  constexpr double d1 = 1e-6, d2 = 4e-6, s = 2e-7, dt = 1e-6;
  constexpr int n = 20000;
  ContactHistory h{};
  double work = 0;
  double overlap = d1;
  double shear_before = 0, normal_before = 0;
  const auto move = [&](double d_overlap, double d_shear) {
    for (int k = 0; k < n; ++k) {
      ContactGeometry g = contact(overlap + d_overlap / n, 0.5e-3, 1);
      g.overlap_before = std::exchange(overlap, g.overlap);
      g.approach = d_overlap / n / dt, g.slide = Trio(0, d_shear / n / dt, 0);
      const ContactForce f = law.force(g, h, dt);
      work += 0.5 * (f.tangential.y + shear_before) * d_shear / n - 0.5 * (f.normal + normal_before) * d_overlap / n;  // trapezoid
      shear_before = f.tangential.y, normal_before = f.normal;
    }
  };
  move(0, 0);  // at rest at d1
  work = 0;
  move(0, s);
  move(d2 - d1, 0);
  move(0, -s);
  move(d1 - d2, 0);
  return work;
}
TEST(LiggghtsHertz, makes_energy_in_the_elata_berryman_loop) {
  const MaterialTable t = table(1e7, .25, 2500, {1, 10, 0, 0});
  EXPECT_NEAR(loop_work(make_liggghts_hertz(t, 0, 0)) / 4.08881e-12, 1, 1e-3);  // 1/2 (k_t2 - k_t1) s^2, made; quadrature of 20000 steps
  EXPECT_LE(loop_work(make_hertz_mindlin(t, 0, 0)), 1e-16);                     // ours never: rounding of 1e-9 J of normal work
}
TEST(LiggghtsHertz, books_the_energy_that_it_makes) {
  const LiggghtsHertz law = make_liggghts_hertz(table(1e7, .25, 2500, {1, 10, 0, 0}), 0, 0);
  ContactGeometry low = contact(1e-6, 0.5e-3, 1), high = contact(4e-6, 0.5e-3, 1);
  low.slide = Trio(0, .2, 0);
  ContactHistory sheared{};
  law.force(low, sheared, 1e-6);
  ContactHistory pressed = sheared;
  high.overlap_before = low.overlap;
  const ContactForce f = law.force(high, pressed, 1e-6);
  EXPECT_NEAR(law.loss(high, sheared, pressed, f, 1e-6).sliding / -4.08881e-12, 1, 1e-5);
  EXPECT_NEAR((law.energy(high, pressed).elastic_tangential - law.energy(low, sheared).elastic_tangential) / 4.08881e-12, 1, 1e-5);
}

// Just below slip the damper comes on top: more than Coulomb allows. One step further it is off.
TEST(LiggghtsHertz, tangential_damping_is_neither_capped_nor_active_in_slip) {
  const LiggghtsHertz law = make_liggghts_hertz(table(1e7, .25, 2500, {.3, .5, 0, 0}), 0, 0);
  ContactGeometry g = contact(4e-6, 0.5e-3, 1e-5);
  g.slide = Trio(0, .1, 0);
  const double cap = .5 * 1.272074e-3, step = .99 * cap / (408.8810 * .1);
  ContactHistory h{};
  const ContactForce stick = law.force(g, h, step);
  EXPECT_NEAR(length(h.spring) / cap, .99, 1e-5);
  EXPECT_GT(length(stick.tangential) / cap, 1.5);
  const ContactForce slip = law.force(g, h, step);
  EXPECT_NEAR(length(slip.tangential) / cap, 1, 1e-6);
  // The cap uses |F_n|, also when it pulls.
  g.approach = -10, g.slide = Trio(0, 1e3, 0);
  ContactHistory fresh{};
  const ContactForce pull = law.force(g, fresh, step);
  ASSERT_LT(pull.normal, 0);
  EXPECT_NEAR(length(pull.tangential) / (.5 * -pull.normal), 1, 1e-12);
}

// Projection without rescaling: a spring in the plane of rotation shrinks by cos(2 pi / N) in each of N steps of a turn; ours is carried along.
TEST(LiggghtsHertz, loses_its_spring_when_the_pair_turns) {
  const MaterialTable t = table(1e7, .25, 2500, {1, 10, .1, 0});
  constexpr int n = 100;
  const auto turned = [&](const auto& law) {
    ContactHistory h{};
    ContactGeometry g = contact(1e-6, 0.5e-3, 1);
    g.slide = Trio(0, 1e-3, 0), g.roll = Trio(0, 0, 1e-3);
    law.force(g, h, 1e-6);
    const double spring = length(h.spring);
    g.slide = g.roll = Trio(0, 0, 0);
    for (int k = 1; k <= n; ++k) {
      const double angle = 2 * std::numbers::pi * k / n;
      const Trio before = g.normal;
      g.normal = Trio(std::cos(angle), std::sin(angle), 0);
      turn_from(g, before);
      law.force(g, h, 1e-6);
    }
    return length(h.spring) / spring;
  };
  EXPECT_NEAR(turned(make_liggghts_hertz(t, 0, 0)), std::pow(std::cos(2 * std::numbers::pi / n), n), 1e-9);
  EXPECT_NEAR(turned(make_hertz_mindlin(t, 0, 0)), 1, 1e-9);
}

// EPSD, verification.md 4.3: k_r = 6.185764e-6 N m, C_r = 5.7138e-9; at first touch of a sphere that rolls with 50 rad/s the damper gives 28 times
// the limit, and the torque keeps its direction when the contact turns.
TEST(LiggghtsHertz, rolling_damping_jolts_and_the_torque_is_not_carried_along) {
  const MaterialTable t{{{"ball", 2500, 1e7, .25}, {"rigid", 1, 1e30, .3}}, {{.5, .5, .1, .3}, {.5, .5, .1, .3}, {.5, .5, .1, .3}, {.5, .5, .1, .3}}};
  const double mass = 2500 * 4.0 / 3 * std::numbers::pi * 1e-9;
  ContactGeometry g = contact(std::pow(3 * mass * 9.81 / (4 * 1e7 / (1 - .0625) * std::sqrt(1e-3)), 2.0 / 3), 1e-3, mass);
  g.i_roll = 1.4 * mass * 1e-6;
  g.roll = Trio(0, 0, 50);
  const LiggghtsHertz law = make_liggghts_hertz(t, 0, 1);
  ContactHistory h{};
  const double dt = 1e-7;
  const ContactForce f = law.force(g, h, dt);
  EXPECT_NEAR(h.rolling.z / (-6.185764e-6 * 50 * dt), 1, 1e-5);
  EXPECT_NEAR((f.rolling.z - h.rolling.z) / (-5.7138e-9 * 50), 1, 1e-4);
  EXPECT_NEAR(-f.rolling.z / 1.0273e-8, 27.8, .1);
  ContactHistory ours{};
  EXPECT_LE(length(make_hertz_mindlin(t, 0, 1).force(g, ours, dt).rolling), 1.0273e-8 * 1.0001);
  // Turned by 90 degrees about y: the torque stays along z and is now a torsion, which a rolling torque must not be.
  g.roll = Trio(0, 0, 0);
  const Trio before = g.normal;
  g.normal = Trio(0, 0, 1);
  turn_from(g, before);
  const Trio held = h.rolling;
  law.force(g, h, dt);
  EXPECT_EQ(h.rolling.z, held.z);
  make_hertz_mindlin(t, 0, 1).force(g, ours, dt);
  EXPECT_NEAR(ours.rolling.z, 0, 1e-12 * length(ours.rolling));
}

// Same law seen from the other side: opposite forces, bit for bit.
TEST(LiggghtsHertz, sides_are_equal) {
  const LiggghtsHertz law = make_liggghts_hertz(table(1e7, .25, 2500, {.4, .5, .1, .3}), 0, 0);
  ContactGeometry a = contact(2e-6, 0.5e-3, 1e-5), b = a;
  a.normal = Trio(.6, .8, 0), b.normal = -a.normal;
  a.slide = Trio(.8, -.6, .3), b.slide = -a.slide;
  a.roll = Trio(3, -2, 5), b.roll = -a.roll;
  a.approach = b.approach = .05;
  ContactHistory ha{}, hb{};
  for (int k = 0; k < 5; ++k) {
    const ContactForce fa = law.force(a, ha, 1e-6), fb = law.force(b, hb, 1e-6);
    EXPECT_EQ(fa.normal, fb.normal);
    EXPECT_EQ(fa.tangential.x, -fb.tangential.x);
    EXPECT_EQ(fa.tangential.z, -fb.tangential.z);
    EXPECT_EQ(fa.rolling.y, -fb.rolling.y);
  }
}
}  // namespace
}  // namespace venato::dem
