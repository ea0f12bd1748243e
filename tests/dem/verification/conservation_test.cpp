/// Conservation, energy, closed loops, objectivity, order of grains, size-ratio trap. Complements tests/dem/engine/conservation_test.cpp (cloud,
/// energy book over an impact, ten turns of a rigid pair): here are exact figures, sweeps, and faulty variants as negative controls.
#include <gtest/gtest.h>

#include <array>

#include "dem/contact/kernels/restitution.h"
#include "tests/dem/verification/scenes.h"
#include "tests/dem/verification/slow_reference.h"

namespace venato::dem::verification {
namespace {
constexpr double kDegree = std::numbers::pi / 180;

/// Oblique impact of unequal spheres 1:3, all components in play: linear and angular momentum (orbital + spin) to rounding, 1e-12. The control
/// integrates the recorded forces with the torque of a lever R on both, as some codes have it: wrong by about the overlap over the radius, 1e-3 here.
TEST(Momentum, UnequalPairAndTheWrongLever) {
  const Ball ball{1e7, .25, 1900, 2e-4};
  Simulation sim(scene::setup(2e-8, alone(ball, {.6, .5, .1, .3})));
  sim.add_grain(scene::grain(Vec3(0, 0, 0), 2e-4, Vec3(.3, .1, -.05), Vec3(100, -300, 200)));
  sim.add_grain(scene::grain(Vec3(6.5e-4, 4.7e-4, 1e-4), 6e-4, Vec3(-.2, 0, .02), Vec3(-50, 20, 80)));
  auto sums = [&] {
    std::array<Vec3, 2> s{Vec3(0, 0, 0), Vec3(0, 0, 0)};
    for (const GrainState& g : sim.grains()) {
      s[0] += g.mass_kg * g.velocity_m_s;
      s[1] += g.mass_kg * g.position_m.cross(g.velocity_m_s) + .4 * g.mass_kg * g.radius_m * g.radius_m * g.spin_rad_s;
    }
    return s;
  };
  const auto before = sums();
  const GrainState a0 = sim.grain(0), b0 = sim.grain(1);
  Vec3 missing = Vec3::Zero();  // what lever R would add to the angular momentum: (d / 2) n x f_t on each side
  double overlap = 0;
  for (int k = 0; k < 20000; ++k) {
    sim.step();
    for (const ContactState& c : sim.contacts())
      missing += c.overlap_m * c.normal.cross(c.tangential_force_n) * sim.time_step_s(), overlap = c.overlap_m;
  }
  EXPECT_TRUE(sim.contacts().empty());
  EXPECT_GT(overlap, 0);
  const auto after = sums();
  const GrainState a1 = sim.grain(0), b1 = sim.grain(1);
  const double turned =
      .4 * a0.mass_kg * 4e-8 * (a1.spin_rad_s - a0.spin_rad_s).norm() + .4 * b0.mass_kg * 36e-8 * (b1.spin_rad_s - b0.spin_rad_s).norm();
  const double scale = a0.mass_kg * a0.velocity_m_s.norm() + b0.mass_kg * b0.velocity_m_s.norm();
  EXPECT_LT((after[0] - before[0]).norm(), 1e-12 * scale);
  EXPECT_LT((after[1] - before[1]).norm(), 1e-12 * before[1].norm());
  EXPECT_LT((after[1] - before[1]).norm(), 1e-10 * turned);
  EXPECT_GT(missing.norm(), 1e-3 * turned);
}

/// The books name the right account. Sliding ball until it rolls (mu_r = 0): m v0^2 / 7 of sliding loss (what tangential vibrations take counts to
/// it); rolling to rest: .7 m v0^2 of rolling loss; head-on impact: (1 - e^2) / 2 m v^2 of normal loss. All exact laws: 0.5 %; the others stay below
/// that.
TEST(EnergyBook, EachLossIsTheAnalyticOne) {
  const Ball bead{1e7, .25, 2500, 1e-3};
  const double m = bead.mass();
  auto lying = [&](const PairProperties& p, double v, double spin, double dt, int steps) {
    SimulationSetup s = scene::setup(dt, on_rigid(bead, p), Vec3(0, 0, -9.81));
    s.track_energy = true;
    Simulation sim(s);
    sim.add_wall(rigid_plane());
    sim.add_grain(scene::grain(Vec3(0, 0, bead.radius - static_overlap(bead, m * 9.81)), bead.radius, Vec3(v, 0, 0), Vec3(0, spin, 0)));
    sim.step(steps);
    return sim.energy();
  };
  const double v_slide = .02, slip = m * v_slide * v_slide / 7, v_roll = .02, rolling = .7 * m * v_roll * v_roll;
  const EnergyBook slide = lying({.3, .4, 0, 0}, v_slide, 0, 4e-6, 2000), roll = lying({.5, .5, .1, .3}, v_roll, v_roll / bead.radius, 4e-6, 17500);
  EXPECT_NEAR((slide.dissipated_sliding_j + slide.dissipated_tangential_damping_j) / slip, 1, 5e-3);
  EXPECT_LT(std::abs(slide.dissipated_normal_j) / slip, 5e-3);
  EXPECT_EQ(slide.dissipated_rolling_j, 0);
  EXPECT_NEAR(roll.dissipated_rolling_j / rolling, 1, 5e-3);
  EXPECT_LT(std::abs(roll.dissipated_j() - roll.dissipated_rolling_j) / rolling, 5e-3);
  for (const double e : {.9, .5, .2}) {
    const double dt = hertz_duration(m, bead.radius, bead.plane_modulus(), .3) / 2000;
    SimulationSetup s = scene::setup(dt, on_rigid(bead, {e, .5, .1, .3}));
    s.track_energy = true;
    Simulation sim(s);
    sim.add_wall(rigid_plane());
    sim.add_grain(scene::grain(Vec3(0, 0, bead.radius + .2 * dt), bead.radius, Vec3(0, 0, -.3)));
    collide(sim);
    const double loss = .5 * (1 - e * e) * m * .09;
    EXPECT_NEAR(sim.energy().dissipated_normal_j / loss, 1, 5e-3) << e;
    EXPECT_NEAR(sim.energy().dissipated_j() / loss, 1, 5e-3) << e;
  }
}

/// No impact may make energy. Chung & Ooi's sphere at 3.9 m/s, angles, frictions and spins; (KE after - before) / before <= 1e-6, and for e = 1 the
/// worst published loss-free case of the rescaled spring is -5.7e-5 (nothing is lost there but a little rescaling): no case may lie below -1.
constexpr double kAngles[] = {1, 9, 17, 25, 33, 41, 49, 57, 65, 73, 81, 89};
double energy_change(const GrainState& a, double spin) {
  const double i = .4 * kAluminiumOxide.radius * kAluminiumOxide.radius, before = 3.9 * 3.9 + i * spin * spin;
  return (a.velocity_m_s.squaredNorm() + i * a.spin_rad_s.squaredNorm() - before) / before;
}
TEST(EnergyGrowth, NeverInOneImpact) {
  double worst = -1, best = 0;
  for (const double e : {1., .98, .8})
    for (const double mu : {.05, .3, 2.})
      for (const double deg : kAngles)
        for (const double turn : {0., 2., -2.}) {
          const double spin = turn * 3.9 / kAluminiumOxide.radius;
          const Impact hit = hit_plane(kAluminiumOxide, {e, mu, 0, 0}, 3.9 * std::cos(deg * kDegree), 3.9 * std::sin(deg * kDegree), spin, 2000);
          const double change = energy_change(hit.a, spin);
          EXPECT_LE(change, 1e-6) << "e " << e << " mu " << mu << " angle " << deg << " spin " << spin;
          worst = std::max(worst, change), best = std::min(best, change);
        }
  EXPECT_GT(worst, -1e-2);  // near the limit there is a case that loses next to nothing, and …
  EXPECT_LT(best, -.2);     // … others lose a lot: the sweep has teeth
}
/// Negative control: the displacement spring gains +5.4e-3 in the worst case published (57 deg, mu = 2, e = 1), by the independent integrator.
TEST(EnergyGrowth, DisplacementSpringWouldMakeEnergy) {
  double gain = -1;
  for (const bool displacement : {true, false}) {
    double most = -1;
    for (const double turn : {0., 2., -2.}) {
      const double v_n = 3.9 * std::cos(57 * kDegree), v_t = 3.9 * std::sin(57 * kDegree);
      const double dt = hertz_duration(kAluminiumOxide.mass(), kAluminiumOxide.radius, kAluminiumOxide.plane_modulus(), v_n) / 4000;
      slow::Body b;
      b.model.young_eff = kAluminiumOxide.plane_modulus(), b.model.shear_eff = kAluminiumOxide.young / (2 * (2 - .23) * 1.23), b.model.friction = 2;
      b.model.displacement_history = displacement;
      b.fixed = {slow::Fixed{}}, b.radius = kAluminiumOxide.radius, b.mass = kAluminiumOxide.mass();
      b.x = Vec3(0, 0, b.radius + .5 * v_n * dt), b.v = Vec3(v_t, 0, -v_n), b.w = Vec3(0, turn * 3.9 / b.radius, 0);
      b.forces(0);
      const double before = b.kinetic();
      for (int k = 0; k < 5000; ++k) b.step(dt);
      most = std::max(most, b.kinetic() / before - 1);
    }
    if (displacement) {
      gain = most;
    } else {
      EXPECT_LE(most, 1e-6);
    }
  }
  EXPECT_NEAR(gain, 5.4e-3, 3e-4);
}

/// Elata & Berryman: shear at one overlap, unshear at the other. W = 1/2 (k_t2 - k_t1) s^2 = 4.08881e-12 J; a displacement spring hands it out in one
/// sense of the loop. The rescaled incremental spring keeps exactly that much in BOTH senses (shear, press, unshear, release: the force left over is
/// lost; press, shear, release, unshear: the shrinking is lost). Work of the hand over the closed path, 1 %: the path is 2000 steps long.
TEST(ClosedLoop, ElataBerrymanLosesTheSameInBothSenses) {
  for (const bool shear_first : {true, false}) {
    const double dt = 1e-7;
    Simulation sim(scene::setup(dt, alone({1e7, .25, 2500, 1e-3}, {1, 100, 0, 0})));
    for (const double x : {0., 2e-3 - 1e-6}) {
      GrainInput g = scene::grain(Vec3(x, 0, 0), 1e-3);
      g.frozen = true;
      sim.add_grain(g);
    }
    sim.evaluate_forces();
    double work = 0;
    auto move = [&](const Vec3& way) {
      sim.set_velocity(1, way / (2000 * dt), Vec3::Zero());
      for (int k = 0; k < 2000; ++k) {
        const Vec3 before = sim.grain(1).force_n;
        sim.step();
        work -= .5 * (before + sim.grain(1).force_n).dot(way / 2000);
      }
    };
    const Vec3 shear(0, 2e-7, 0), press(-3e-6, 0, 0);
    for (const Vec3& way : shear_first ? std::array{shear, press, Vec3(-shear), Vec3(-press)} : std::array{press, shear, Vec3(-press), Vec3(-shear)})
      move(way);
    EXPECT_NEAR(work / 4.08881e-12, 1, 1e-2) << shear_first;
  }
}
/// Any closed path in (overlap, shear), without slip: never a gain. 40 random polygons; rounding and trapezoid 1e-3 of the loop energy above.
TEST(ClosedLoop, RandomPathsNeverGain) {
  Rng rng(11, 4);
  double lost = 0;
  for (int path = 0; path < 40; ++path) {
    const double dt = 1e-7;
    Simulation sim(scene::setup(dt, alone({1e7, .25, 2500, 1e-3}, {1, 100, 0, 0})));
    for (const double x : {0., 2e-3 - 2.5e-6}) {
      GrainInput g = scene::grain(Vec3(x, 0, 0), 1e-3);
      g.frozen = true;
      sim.add_grain(g);
    }
    sim.evaluate_forces();
    double work = 0;
    Vec3 at = Vec3::Zero();
    for (int corner = 0; corner < 5; ++corner) {
      const Vec3 to = corner == 4 ? Vec3(0, 0, 0) : Vec3(4e-6 * (rng.uniform() - .5), 4e-7 * (rng.uniform() - .5), 4e-7 * (rng.uniform() - .5));
      const Vec3 way = to - at;
      sim.set_velocity(1, way / (500 * dt), Vec3::Zero());
      for (int k = 0; k < 500; ++k) {
        const Vec3 before = sim.grain(1).force_n;
        sim.step();
        work -= .5 * (before + sim.grain(1).force_n).dot(way / 500);
      }
      at = to;
    }
    EXPECT_GT(work, -1e-3 * 4.08881e-12) << path;
    lost += work;
  }
  EXPECT_GT(lost, 4e-12);  // most of them lose
}

/// A pressed, sheared pair turned as a rigid body by 100 and a quarter turns in steps of 1/400 turn, about axes across, along and askew to the
/// normal: force and rolling torque keep their size and come round with the pair, 1e-6. Not whole turns: there a spring that stays behind in space
/// would look right. Negative controls, same check: the same spring by bare projection, which loses 2 pi^2 / N per turn (and does not follow a spin
/// about the normal at all), and a rolling spring that is not turned with the contact, as in LIGGGHTS.
TEST(Objectivity, HundredAndAQuarterTurnsOfARigidPair) {
  const double dt = 1e-6;
  const int n = 400, steps = 100 * n + n / 4;
  const double rate = 2 * std::numbers::pi / (n * dt);
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(Vec3(1, 2, 3).normalized())}) {
    Simulation sim(scene::setup(dt, alone({1e7, .25, 2500, 1e-3}, {1, .8, .1, 0})));
    for (const double x : {-.999e-3, .999e-3}) {
      GrainInput g = scene::grain(Vec3(x, 0, 0), 1e-3);
      g.frozen = true;
      sim.add_grain(g);
    }
    sim.set_velocity(0, Vec3(0, 2e-3, 0), Vec3(0, 0, .2)), sim.step(100);
    sim.set_velocity(0, Vec3::Zero(), Vec3::Zero()), sim.step(1);
    const ContactState before = sim.contacts().at(0);
    ASSERT_GT(before.rolling_spring_n_m.norm(), 0);
    const Vec3 middle = .5 * (sim.grain(0).position_m + sim.grain(1).position_m), arm = sim.grain(0).position_m - middle;
    Vec3 projected = before.tangential_spring_n, projected_one_turn = projected;
    for (int k = 0; k < steps; ++k) {
      const Eigen::AngleAxisd now(rate * k * dt, axis), next(rate * (k + 1) * dt, axis);
      const Vec3 way = next * arm - now * arm, spin = 2 * std::tan(rate * dt / 2) / dt * axis;
      sim.set_velocity(0, way / dt, spin), sim.set_velocity(1, -way / dt, spin);
      sim.step(1);
      const Vec3 normal = (next * arm).normalized();
      projected -= projected.dot(normal) * normal;
      if (k == n - 1) projected_one_turn = projected;
    }
    const ContactState after = sim.contacts().at(0);
    const Eigen::AngleAxisd quarter(rate * steps * dt, axis);
    EXPECT_LT((after.normal - quarter * before.normal).norm(), 1e-6);
    auto came_round = [&](const Vec3& now, const Vec3& then) { return (now - quarter * then).norm() <= 1e-6 * then.norm(); };
    EXPECT_TRUE(came_round(after.tangential_spring_n, before.tangential_spring_n));
    EXPECT_TRUE(came_round(after.rolling_spring_n_m, before.rolling_spring_n_m));
    EXPECT_FALSE(came_round(projected, before.tangential_spring_n));
    if (axis.z() == 1) {
      EXPECT_NEAR(projected_one_turn.norm() / before.tangential_spring_n.norm(), std::exp(-2 * std::numbers::pi * std::numbers::pi / n), 1e-3);
    } else {  // the rolling spring points along z: a turn about z would not move it
      EXPECT_FALSE(came_round(before.rolling_spring_n_m, before.rolling_spring_n_m));
    }
  }
}

/// Seven grains that fall on a plane and each other, in any frame: `turn` turns the scene with gravity and wall, `drift` is added to every velocity.
std::vector<GrainState> pile(const Eigen::Matrix3d& turn, const Vec3& drift, const std::vector<int>& order = {0, 1, 2, 3, 4, 5, 6},
                             bool disturb = false) {
  const Ball ball{1e7, .25, 1900, 2e-4};
  Simulation sim(scene::setup(2e-6, alone(ball, {.3, .5, .1, .3}), turn * Vec3(0, 0, -100)));  // in a centrifuge: they pile up in milliseconds
  Wall floor = scene::plane(Vec3::Zero(), turn * Vec3::UnitZ());
  floor.motion.velocity_m_s = drift;
  sim.add_wall(floor);
  if (disturb) sim.add_grain(scene::grain(turn * Vec3(0, 0, .05), 2e-4));
  for (const int k : order) {
    const double r = 2e-4 + 3e-5 * k;
    const Vec3 at((k % 3) * 4.1e-4 + 3e-5 * k, (k / 3) * 3.3e-4, 4e-4 + 5.2e-4 * (k / 2)), v(.1 - .03 * k, .05 * (k % 2), -.2);
    sim.add_grain(scene::grain(turn * at, r, turn * v + drift, turn * Vec3(50 * k, -100, 30)));
  }
  sim.step(2500);
  if (disturb) {  // in mid-contact: the grains get other places in memory
    EXPECT_GT(sim.statistics().contact_count, 1);
    sim.remove_grain(0);
    for (int k = 0; k < 3; ++k) sim.insert_free_grain(scene::grain(turn * Vec3(0, 0, .06 + .01 * k), 1e-3));
  }
  sim.step(1500);
  EXPECT_GT(sim.statistics().contact_count, 2);
  std::vector<GrainState> all = sim.grains();
  if (disturb) all.resize(7);
  return all;
}
/// Galilean invariance and turned frames: positions within 1e-10 of the extent (1 mm), velocities 1e-10 of 1 m/s, spins 1e-10 of 1e4 rad/s; rounding
/// of the shifted coordinates is about 1e-13.
TEST(Objectivity, GalileanAndTurnedFrames) {
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity(), turn = Eigen::AngleAxisd(37 * kDegree, Vec3(1, 2, -.5).normalized()).toRotationMatrix();
  const Vec3 drift(.7, -.4, .25);
  const auto rest = pile(none, Vec3::Zero()), moving = pile(none, drift), turned = pile(turn, Vec3::Zero());
  double spun = 0;
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_LT((moving[k].position_m - 8e-3 * drift - rest[k].position_m).norm(), 1e-10 * 1e-3) << k;
    EXPECT_LT((moving[k].velocity_m_s - drift - rest[k].velocity_m_s).norm(), 1e-10) << k;
    EXPECT_LT((moving[k].spin_rad_s - rest[k].spin_rad_s).norm(), 1e-6) << k;
    EXPECT_LT((turned[k].position_m - turn * rest[k].position_m).norm(), 1e-10 * 1e-3) << k;
    EXPECT_LT((turned[k].velocity_m_s - turn * rest[k].velocity_m_s).norm(), 1e-10) << k;
    EXPECT_LT((turned[k].spin_rad_s - turn * rest[k].spin_rad_s).norm(), 1e-6) << k;
    spun = std::max(spun, (rest[k].spin_rad_s - Vec3(50. * static_cast<double>(k), -100, 30)).norm());
  }
  EXPECT_GT(spun, 100);  // they really collided with friction
}
/// The order in which the grains were named, and renumbering in memory in mid-contact, change nothing but the order of sums: 1e-12 of the scales,
/// each history with its sign under the swap of i and j (a wrong sign would be an error of order 1).
TEST(Order, SwappedAndRenumberedGrains) {
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  const std::vector<int> other{6, 2, 4, 0, 5, 1, 3};
  const auto a = pile(none, Vec3::Zero()), b = pile(none, Vec3::Zero(), other), c = pile(none, Vec3::Zero(), {0, 1, 2, 3, 4, 5, 6}, true);
  for (std::size_t k = 0; k < 7; ++k) {
    const std::size_t was = static_cast<std::size_t>(other[k]);
    EXPECT_LT((b[k].position_m - a[was].position_m).norm(), 1e-12 * 1e-3);
    EXPECT_LT((b[k].velocity_m_s - a[was].velocity_m_s).norm(), 1e-12);
    EXPECT_LT((b[k].spin_rad_s - a[was].spin_rad_s).norm(), 1e-12 * 1e4);
    EXPECT_LT((c[k].position_m - a[k].position_m).norm(), 1e-12 * 1e-3);
    EXPECT_LT((c[k].velocity_m_s - a[k].velocity_m_s).norm(), 1e-12);
    EXPECT_LT((c[k].spin_rad_s - a[k].spin_rad_s).norm(), 1e-12 * 1e4);
  }
}

/// Size-ratio trap (Vyas et al. 2025): a grain r = .25 mm rolls off the valley between two fixed touching spheres R_L, from 1 deg. Until it slips,
/// phi'' = lam^2 sin phi. A scheme that grows the tangential spring along the full-step normal lets go too late, and from R_L / r = 20 never.
struct RollOff {
  double at_30 = 0, at_60 = 0, lift_off = 0, phi_at_50_ms = 0;
};
constexpr double kSmall = .25e-3, kTrapStep = 1e-6;
double valley_radius(double ratio) { return std::sqrt((ratio + 1) * (ratio + 1) - ratio * ratio) * kSmall; }
double valley_overlap(double ratio) {  // static: two contacts carry m g at 1 deg, each inclined by the valley's angle
  const double m = 4. / 3 * std::numbers::pi * kSmall * kSmall * kSmall * 2500, young = 5e8 / (2 * (1 - .09)), r_eff = kSmall * ratio / (ratio + 1);
  const double f = m * 9.81 / (2 * valley_radius(ratio) / (kSmall * (ratio + 1)));
  return std::pow(3 * f / (4 * young * std::sqrt(r_eff)), 2. / 3);
}
Vec3 valley_start(double ratio) {
  const double reach = (ratio + 1) * kSmall - valley_overlap(ratio), side = ratio * kSmall, h = std::sqrt(reach * reach - side * side);
  return Vec3(0, h * std::sin(kDegree), h * std::cos(kDegree));
}
/// Lift-off: the gap reaches 1 um. That is how the published times for ratios 2 and 4 read, where every scheme gives the same path (first loss of
/// touch is 1.5 ms earlier there, with any transport, damping or step).
template <class Next>  // next() -> position
RollOff watch_roll(double ratio, double longest, const Next& next) {
  RollOff r;
  for (int k = 1; k * kTrapStep < longest; ++k) {
    const Vec3 x = next();
    const double phi = std::atan2(x.y(), x.z()), t = k * kTrapStep;
    if (k == 50000) r.phi_at_50_ms = phi / kDegree;
    if (r.at_30 == 0 && phi > 30 * kDegree) r.at_30 = t;
    if (r.at_60 == 0 && phi > 60 * kDegree) r.at_60 = t;
    if ((x - Vec3(ratio * kSmall, 0, 0)).norm() > (ratio + 1) * kSmall + 1e-6) {
      r.lift_off = t;
      break;
    }
  }
  return r;
}
RollOff engine_roll(double ratio, double longest) {
  Simulation sim(scene::setup(kTrapStep, alone({5e8, .3, 2500, kSmall}, {.5, .5, 0, 0}), Vec3(0, 0, -9.81)));
  for (const double x : {-ratio, ratio}) {
    GrainInput g = scene::grain(Vec3(x * kSmall, 0, 0), ratio * kSmall);
    g.frozen = true;
    sim.add_grain(g);
  }
  const GrainId small = sim.add_grain(scene::grain(valley_start(ratio), kSmall));
  return watch_roll(ratio, longest, [&] {
    sim.step();
    return sim.grain(small).position_m;
  });
}
RollOff slow_roll(double ratio, double longest, bool half_step_normal, bool twist) {
  slow::Body b;
  b.model.young_eff = 5e8 / (2 * (1 - .09)), b.model.shear_eff = 5e8 / (4 * 1.7 * 1.3), b.model.beta = damping_for_restitution(.5),
  b.model.friction = .5;
  b.model.half_step_normal = half_step_normal, b.model.twist = twist;
  b.fixed = {{Vec3(-ratio * kSmall, 0, 0), ratio * kSmall}, {Vec3(ratio * kSmall, 0, 0), ratio * kSmall}};
  b.radius = kSmall, b.mass = 4. / 3 * std::numbers::pi * kSmall * kSmall * kSmall * 2500, b.gravity = Vec3(0, 0, -9.81), b.x = valley_start(ratio);
  b.forces(0);
  return watch_roll(ratio, longest, [&] {
    b.step(kTrapStep);
    return b.x;
  });
}
/// Times to 30 and 60 deg 1 %, lift-off 2 % (published), phi(.05 s) 1 %. The lift-off at 10 and 20 also depends on how a spring is carried when only
/// one of the two bodies spins about the normal; the engine turns it by the mean spin, and so does the independent integrator here: 0.5 % between the
/// two.
TEST(SizeRatioTrap, SmallGrainLetsGoOfBigOnes) {
  const double none = 0;
  const double table[][5] = {
      {2, none, .04059, .04751, .0482}, {4, 25.50, .05209, .06099, .0622}, {10, 6.410, .08054, .09451, .0980}, {20, 2.828, .12060, .14151, .1505}};
  for (const auto& row : table) {
    const RollOff r = engine_roll(row[0], 1.2 * row[4]), slow = slow_roll(row[0], 1.2 * row[4], true, true);
    if (row[1] != none) {
      EXPECT_NEAR(r.phi_at_50_ms / row[1], 1, 1e-2) << row[0];
    }
    EXPECT_NEAR(r.at_30 / row[2], 1, 1e-2) << row[0];
    EXPECT_NEAR(r.at_60 / row[3], 1, 1e-2) << row[0];
    EXPECT_NEAR(r.lift_off / row[4], 1, 2e-2) << row[0];
    EXPECT_NEAR(r.lift_off / slow.lift_off, 1, 5e-3) << row[0];
  }
}
/// Negative control: the standard scheme in the independent integrator lets go late at ratio 10 (.1022 published) and never at 20 (150 deg and
/// beyond).
TEST(SizeRatioTrap, StandardSchemeTrapsTheGrain) {
  for (const bool twist : {false, true}) {
    EXPECT_NEAR(slow_roll(10, .12, false, twist).lift_off / .1022, 1, 1e-2);
    EXPECT_EQ(slow_roll(20, .18, false, twist).lift_off, 0);
  }
}
}  // namespace
}  // namespace venato::dem::verification
