/// The wide sweeps behind the unit tests of impacts, rolling and the size-ratio trap.
#include <gtest/gtest.h>

#include "tests/dem/verification/scenes.h"
#include "tests/dem/verification/slow_reference.h"

namespace venato::dem::verification {
namespace {
constexpr double kDegree = std::numbers::pi / 180;
double textbook(double e) { return -std::log(e) / std::hypot(std::log(e), std::numbers::pi); }

struct Rebound {
  double e_t, spin, angle;  ///< angle of the contact point's velocity
};
Rebound rebound(const Vec3& v, const Vec3& w, double v_t, double r) { return {v.x() / v_t, -w.y(), std::atan2(v.x() - r * w.y(), v.z()) / kDegree}; }
slow::Body slow_ball(const Ball& b, double beta, double mu, double v_n, double v_t, double dt) {
  slow::Body body;
  body.model.young_eff = b.plane_modulus(), body.model.shear_eff = b.young / (2 * (2 - b.poisson) * (1 + b.poisson));
  body.model.beta = beta, body.model.friction = mu;
  body.fixed = {slow::Fixed{}}, body.radius = b.radius, body.mass = b.mass();
  body.x = Vec3(0, 0, b.radius + .5 * v_n * dt), body.v = Vec3(v_t, 0, -v_n);
  body.forces(0);
  return body;
}
/// Chung & Ooi test 4 at every published angle: against the published figures of the engine's variant (rescaled incremental spring; where the
/// variants agree the one figure stands for all), 0.3 %, rebound angle 0.3 % of 90 deg; against the paper's own DEM curve (digitised; a displacement
/// spring, so from 15 deg on) 2.5 % of e_t and of the largest spin, 1.2 deg. And every degree against the independent integrator: 0.3 % (of v for e_t
/// near its zero slope).
TEST(ChungOoi, Test4AtEveryAngle) {
  const double none = 1e9;
  const double table[][7] = {{2, .8705, -17.62, none, none, none, none},      {5, .8583, -48.16, none, none, none, none},
                             {10, .7145, -193.4, none, none, none, none},     {15, .6348, -368.6, none, .624, -378, none},
                             {20, .6226, -503.4, -6.79, .616, -510.6, -7.54}, {25, .6397, -593.9, -7.08, .634, -599.4, -7.54},
                             {30, .6845, -615.3, -3.52, .684, -616.5, -3.55}, {35, .7398, -582.0, 3.66, .737, -582.3, 3.43},
                             {40, .7829, -544.2, 11.62, .781, -544.8, 11.57}, {45, .8178, -502.4, 20.29, none, none, none},
                             {50, .8471, -456.7, 29.49, .845, -457, 29.35},   {60, .8948, -355.2, 48.16, .893, -357.5, 47.8},
                             {70, .9337, -243.0, 65.08, .932, -246.2, 64.6},  {80, .9679, -123.4, 78.98, .966, -126.3, 78.7},
                             {85, .9841, -61.9, 84.81, .983, -63.1, 84.5}};
  auto run = [](double deg) {
    const double v_t = 3.9 * std::sin(deg * kDegree);
    const Impact hit = hit_plane(kAluminiumOxide, {.98008, .092, 0, 0}, 3.9 * std::cos(deg * kDegree), v_t, 0, 4000);
    return rebound(hit.a.velocity_m_s, hit.a.spin_rad_s, v_t, kAluminiumOxide.radius);
  };
  for (const auto& row : table) {
    const Rebound r = run(row[0]);
    EXPECT_NEAR(r.e_t / row[1], 1, 3e-3) << row[0];
    EXPECT_NEAR(r.spin / row[2], 1, 3e-3) << row[0];
    if (row[3] != none) {
      EXPECT_NEAR(r.angle, row[3], .27) << row[0];
    }
    if (row[4] != none) {
      EXPECT_NEAR(r.e_t / row[4], 1, 2.5e-2) << row[0];
    }
    if (row[5] != none) {
      EXPECT_NEAR(r.spin, row[5], 2.5e-2 * 616) << row[0];
    }
    if (row[6] != none) {
      EXPECT_NEAR(r.angle, row[6], 1.2) << row[0];
    }
  }
  for (int deg = 1; deg < 90; ++deg) {
    const double v_n = 3.9 * std::cos(deg * kDegree), v_t = 3.9 * std::sin(deg * kDegree);
    const double dt = hertz_duration(kAluminiumOxide.mass(), kAluminiumOxide.radius, kAluminiumOxide.plane_modulus(), v_n) / 4000;
    slow::Body b = slow_ball(kAluminiumOxide, textbook(.98), .092, v_n, v_t, dt);
    for (int k = 0; k < 6000; ++k) b.step(dt);
    const Rebound r = run(deg), s = rebound(b.v, b.w, v_t, kAluminiumOxide.radius);
    EXPECT_NEAR(r.e_t, s.e_t, 3e-3) << deg;
    EXPECT_NEAR(r.spin, s.spin, 3e-3 * 616) << deg;
  }
}
/// Chung & Ooi test 5 from sticking to sliding in steps of .25 of psi against the independent integrator: 0.5 % of the value, 2e-3 at least.
TEST(ChungOoi, Test5WholeMawPlot) {
  const Ball steel{2.08e11, .3, 7850, 1e-5};
  const double mu = .3, v_n = 5, dt = hertz_duration(steel.mass(), steel.radius, steel.plane_modulus(), v_n) / 4000;
  for (double psi = .25; psi < 14; psi += .25) {
    slow::Body b = slow_ball(steel, 0, mu, v_n, psi * mu * v_n, dt);
    for (int k = 0; k < 4500; ++k) b.step(dt);
    const GrainState a = hit_plane(steel, {1, mu, 0, 0}, v_n, psi * mu * v_n, 0, 4000).a;
    const double engine = (a.velocity_m_s.x() - steel.radius * a.spin_rad_s.y()) / (mu * v_n), slow = (b.v.x() - steel.radius * b.w.y()) / (mu * v_n);
    EXPECT_NEAR(engine, slow, std::max(2e-3, 5e-3 * std::abs(slow))) << psi;
    if (psi >= 6.5) {
      EXPECT_NEAR(engine, psi - 7, 1e-3 * psi) << psi;
    }
  }
}

/// No impact makes energy: Chung & Ooi's sphere at 1 ... 89 deg by 2, six frictions, three spins, four restitutions, 4000 steps per contact:
/// (KE after - before) / before <= 1e-6. The part left without the normal motion (tangential and spin) may not grow by more than 1e-6 of the whole
/// either.
TEST(EnergyGrowth, NeverInTheWholeSweep) {
  double worst = -1, worst_part = -1;
  for (const double e : {1., .98, .8, .5})
    for (const double mu : {.05, .092, .3, .5, 1., 2.})
      for (int deg = 1; deg < 90; deg += 2)
        for (const double turn : {0., 2., -2.}) {
          const double r = kAluminiumOxide.radius, i = .4 * r * r, spin = turn * 3.9 / r, v_t = 3.9 * std::sin(deg * kDegree);
          const GrainState a = hit_plane(kAluminiumOxide, {e, mu, 0, 0}, 3.9 * std::cos(deg * kDegree), v_t, spin, 4000).a;
          const double before = 3.9 * 3.9 + i * spin * spin, after = a.velocity_m_s.squaredNorm() + i * a.spin_rad_s.squaredNorm();
          const double part = a.velocity_m_s.head<2>().squaredNorm() + i * a.spin_rad_s.squaredNorm() - v_t * v_t - i * spin * spin;
          EXPECT_LE(after / before - 1, 1e-6) << "e " << e << " mu " << mu << " angle " << deg << " turn " << turn;
          EXPECT_LE(part / before, 1e-6) << "e " << e << " mu " << mu << " angle " << deg << " turn " << turn;
          worst = std::max(worst, after / before - 1), worst_part = std::max(worst_part, part / before);
        }
  std::printf("largest growth %.2e, without the normal part %.2e\n", worst, worst_part);
  EXPECT_GT(worst, -1e-3);  // there are cases that lose next to nothing
}

/// Ai et al., all ten points of the regime map: launched up-slope at .5 m/s without spin, eta_r = .3, state after 1 s. 1 %; zeros 1 % of the launch
/// speed. The spin at 20 deg, mu_r = .24 is the engine's capped variant's (see rolling_test.cpp), .2195.
TEST(Ai, WholeRegimeMap) {
  const Ball ball{1e9, .3, 5 / (4. / 3 * std::numbers::pi * .008), .2};
  const double table[][4] = {
      {5, 0, -.2529, -.2529},   {5, .05, -.1697, -.1697},  {5, .1, 0, 0},       {10, .05, -.6744, -.6744},  {15, .2, -.4143, -.4143},
      {20, .2, -.9797, -.9797}, {20, .24, -.9623, -.2195}, {20, .3, -.9634, 0}, {30, .15, -2.557, -1.9459}, {40, .1, -4.1107, -2.6099}};
  for (const auto& row : table) {
    const double a = row[0] * kDegree, g = 9.8;
    Simulation sim(scene::setup(2e-5, on_rigid(ball, {.5, .25, row[1], .3}), g * Vec3(-std::sin(a), 0, -std::cos(a))));
    sim.add_wall(rigid_plane());
    sim.add_grain(scene::grain(Vec3(0, 0, ball.radius - static_overlap(ball, ball.mass() * g * std::cos(a))), ball.radius, Vec3(.5, 0, 0)));
    sim.step(50000);
    const GrainState s = sim.grain(0);
    EXPECT_NEAR(s.velocity_m_s.x(), row[2], std::max(5e-3, 1e-2 * std::abs(row[2]))) << row[0] << " " << row[1];
    EXPECT_NEAR(s.spin_rad_s.y() * ball.radius, row[3], std::max(5e-3, 1e-2 * std::abs(row[3]))) << row[0] << " " << row[1];
  }
}

/// Size-ratio trap at R_L / r = 20: with the half-step normal the time of lift-off does not depend on the step, 5e-6 ... 2e-7 s: .1505 s, 2 %. (The
/// standard scheme never lets go at steps of 4e-7 and more: conservation_test.cpp.)
TEST(SizeRatioTrap, LiftOffDoesNotDependOnTheStep) {
  const double r = .25e-3, ratio = 20, m = 4. / 3 * std::numbers::pi * r * r * r * 2500, reach = (ratio + 1) * r;
  const double height = std::sqrt(reach * reach - ratio * ratio * r * r), f = m * 9.81 / (2 * height / reach);
  const double overlap = std::pow(3 * f / (4 * 5e8 / (2 * .91) * std::sqrt(r * ratio / (ratio + 1))), 2. / 3);
  const double h = std::sqrt((reach - overlap) * (reach - overlap) - ratio * ratio * r * r);
  for (const double dt : {5e-6, 2e-6, 6.1e-7, 2e-7}) {
    Simulation sim(scene::setup(dt, alone({5e8, .3, 2500, r}, {.5, .5, 0, 0}), Vec3(0, 0, -9.81)));
    for (const double x : {-ratio, ratio}) {
      GrainInput big = scene::grain(Vec3(x * r, 0, 0), ratio * r);
      big.frozen = true;
      sim.add_grain(big);
    }
    sim.add_grain(scene::grain(h * Vec3(0, std::sin(kDegree), std::cos(kDegree)), r));
    double lift_off = std::nan("");
    while (sim.time_s() < .2) {
      sim.step();
      if ((sim.grain(2).position_m - Vec3(ratio * r, 0, 0)).norm() > reach + 1e-6) {
        lift_off = sim.time_s();
        break;
      }
    }
    EXPECT_NEAR(lift_off / .1505, 1, 2e-2) << dt;
  }
}
}  // namespace
}  // namespace venato::dem::verification
