/// Spheres under gravity: free fall, two stacked spheres between walls (MFIX-DEM case 03 with Hertz contacts), a bouncing ball, a ball that slides
/// until it rolls (MFIX-DEM case 04).
#include <gtest/gtest.h>

#include <array>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
/// Velocity Verlet is exact for constant acceleration: x0 + v t - g t^2 / 2, spin untouched. 1e-10 (Yade's limit); rounding of 10^4 steps is 1e-13.
TEST(FreeFall, IsTheParabola) {
  Simulation sim(scene::setup(1e-5, scene::powder(), Vec3(.3, -1.2, -9.81)));
  const Vec3 x0(.01, .02, .5), v0(.7, -.4, 2), w0(10, -20, 30);
  sim.add_grain(scene::grain(x0, 2e-4, v0, w0));
  sim.step(10000);
  const Vec3 g(.3, -1.2, -9.81), x = x0 + .1 * v0 + .5 * .01 * g, v = v0 + .1 * g;
  EXPECT_LT((sim.grain(0).position_m - x).norm(), 1e-10 * x.norm());
  EXPECT_LT((sim.grain(0).velocity_m_s - v).norm(), 1e-10 * v.norm());
  EXPECT_EQ(sim.grain(0).spin_rad_s, w0);
}

/// Two spheres R = .5 mm, densities 2e4 and 1e4, E = 10 MPa, nu = .25, e = 1, between rigid walls at 0 and 1.8 mm. No friction, nothing turns.
Simulation stacked(double low, double high, double gravity, double dt) {
  const MaterialTable table{{{"heavy", 2e4, 1e7, .25}, {"light", 1e4, 1e7, .25}, {"rigid", 1, 1e30, .3}},
                            std::vector<PairProperties>(9, {1, 0, 0, 0})};
  Simulation sim(scene::setup(dt, table, Vec3(0, 0, -gravity)));
  for (const double z : {0., 1.8e-3}) {
    Wall w = scene::plane(Vec3(0, 0, z), z > 0 ? Vec3(0, 0, -1) : Vec3(0, 0, 1));
    w.material = 2;
    sim.add_wall(w);
  }
  GrainInput a = scene::grain(Vec3(0, 0, low), 5e-4), b = scene::grain(Vec3(0, 0, high), 5e-4);
  b.material = 1;
  sim.add_grain(a), sim.add_grain(b);
  return sim;
}
/// The same two centres by Runge-Kutta on the bare Hertz formulas. `wall_radius_factor`: R* on a wall over R; 1 is right, 1/2 treats it as a pair.
std::array<double, 2> stacked_rk4(double low, double high, double gravity, double time, double wall_radius_factor = 1) {
  const double r = 5e-4, y = 1e7 / .9375, m[2] = {4. / 3 * std::numbers::pi * r * r * r * 2e4, 4. / 3 * std::numbers::pi * r * r * r * 1e4};
  auto hertz = [](double young, double radius, double d) { return d > 0 ? 4. / 3 * young * std::sqrt(radius) * std::pow(d, 1.5) : 0; };
  using State = std::array<double, 4>;
  auto slope = [&](const State& s) {
    const double floor = hertz(y, wall_radius_factor * r, r - s[0]), pair = hertz(y / 2, r / 2, 2 * r - (s[1] - s[0])),
                 lid = hertz(y, wall_radius_factor * r, s[1] + r - 1.8e-3);
    return State{s[2], s[3], (floor - pair) / m[0] - gravity, (pair - lid) / m[1] - gravity};
  };
  State s{low, high, 0, 0};
  const int n = 40000;
  const double h = time / n;
  for (int k = 0; k < n; ++k) {
    auto plus = [](const State& a, double f, const State& d) { return State{a[0] + f * d[0], a[1] + f * d[1], a[2] + f * d[2], a[3] + f * d[3]}; };
    const State a = slope(s), b = slope(plus(s, h / 2, a)), c = slope(plus(s, h / 2, b)), d = slope(plus(s, h, c));
    for (std::size_t i = 0; i < 4; ++i) s[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return {s[0], s[1]};
}
/// Centres from .44 / 1.36 mm at rest: published [mm] to seven figures. 1e-3 of an overlap of 60 um = 6e-8 m; at 1e-8 s the step's error is far
/// below.
constexpr double kStacked[][3] = {{.2e-3, .4502500e-3, 1.3651630e-3},
                                  {.4e-3, .4469025e-3, 1.3624393e-3},
                                  {.6e-3, .4420169e-3, 1.3579220e-3},
                                  {.8e-3, .4532991e-3, 1.3621699e-3},
                                  {1e-3, .4444872e-3, 1.3547869e-3}};
bool stacked_as_published(const std::array<double, 2>& z, const double (&row)[3]) {
  return std::abs(z[0] - row[1]) <= 6e-8 && std::abs(z[1] - row[2]) <= 6e-8;
}
TEST(Stacked, TwoSpheresBetweenWalls) {
  Simulation sim = stacked(.44e-3, 1.36e-3, 9.81, 1e-8);
  for (const auto& row : kStacked) {
    sim.step(20000);
    const std::array<double, 2> z{sim.grain(0).position_m.z(), sim.grain(1).position_m.z()};
    EXPECT_TRUE(stacked_as_published(z, row)) << row[0] << ": " << z[0] << " " << z[1];
    EXPECT_TRUE(stacked_as_published(stacked_rk4(.44e-3, 1.36e-3, 9.81, row[0]), row)) << row[0];
    EXPECT_FALSE(stacked_as_published(stacked_rk4(.44e-3, 1.36e-3, 9.81, row[0], .5), row)) << row[0];  // negative control
  }
}
/// .45 / 1.35 mm without gravity is an equilibrium: Y*, R* of pair and wall cancel identically (2^(3/2) (1/2)(1/2)^(1/2) = 1). Rounding only: 1e-12
/// of the radius after 10^4 steps. The start of the test above is none.
TEST(Stacked, ForcesOfPairAndWallsCancel) {
  Simulation rest = stacked(.45e-3, 1.35e-3, 0, 1e-7), off = stacked(.44e-3, 1.36e-3, 0, 1e-7);
  rest.step(10000), off.step(1000);
  EXPECT_GT(rest.contacts().at(0).normal_force_n, 1e-3);
  EXPECT_LT(std::abs(rest.grain(0).position_m.z() - .45e-3), 5e-16);
  EXPECT_LT(std::abs(rest.grain(1).position_m.z() - 1.35e-3), 5e-16);
  EXPECT_GT(std::abs(off.grain(0).position_m.z() - .44e-3), 1e-6);
}

/// MFIX-DEM's ball (R = .1 m, 2600 kg/m3) let fall from .5 m: bounce k tops at h_k = (h0 - R) e^(2k) + R in the hard limit. E = 10 GPa (100 for the
/// slow bounces of e = .6) makes contacts so short that gravity in them takes less than the tolerance, 4e-3 of the height per bounce (2e-3 of e). The
/// top is taken from speed and place in flight.
TEST(Bounce, HeightsFallGeometrically) {
  for (const double e : {.9, .6}) {
    const Ball ball{e > .8 ? 1e10 : 1e11, .25, 2600, .1};
    Simulation sim(scene::setup(e > .8 ? 2e-6 : 7e-7, on_rigid(ball, {e, .3, 0, 0}), Vec3(0, 0, -9.81)));
    sim.add_wall(rigid_plane());
    sim.add_grain(scene::grain(Vec3(0, 0, .5), .1));
    double last_v = 0;
    for (int k = 1; k <= 4;) {
      sim.step(100);
      const GrainState s = sim.grain(0);
      const double v = s.velocity_m_s.z();
      if (last_v <= 0 && v > 0 && s.position_m.z() > .1) {  // just gone up
        const double top = s.position_m.z() + v * v / (2 * 9.81) - .1;
        EXPECT_NEAR(top / (.4 * std::pow(e, 2 * k)), 1, 4e-3 * k) << e << " bounce " << k;
        ++k;
        last_v = v;
      } else if (v <= 0 || s.position_m.z() > .1) {
        last_v = v;
      }
    }
  }
}

/// MFIX-DEM case 04: R = .5 mm, 1e4 kg/m3, laid down sliding at .1 m/s. Inside the slip v = v0 - mu g t and w = 5/2 mu g t / R; slip ends at 2/7 v0 /
/// (mu g) with v = R w = 5/7 v0; then nothing changes. 0.5 % (MFIX: up to .57 %).
TEST(SlideToRoll, LawInsideAndAfterTheSlip) {
  const Ball ball{1e7, .25, 1e4, 5e-4};
  for (const double mu : {.2, .4, .6, .8, 1.}) {
    const double v0 = .1, g = 9.81, t = 2. / 7 * v0 / (mu * g), dt = t / 4000;
    Simulation sim(scene::setup(dt, on_rigid(ball, {.3, mu, 0, 0}), Vec3(0, 0, -g)));
    sim.add_wall(rigid_plane());
    sim.add_grain(scene::grain(Vec3(0, 0, ball.radius - static_overlap(ball, ball.mass() * g)), ball.radius, Vec3(v0, 0, 0)));
    sim.step(2000);
    EXPECT_NEAR((v0 - sim.grain(0).velocity_m_s.x()) / (mu * g * t / 2), 1, 5e-3) << mu;
    EXPECT_NEAR(sim.grain(0).spin_rad_s.y() * ball.radius / (2.5 * mu * g * t / 2), 1, 5e-3) << mu;
    EXPECT_NEAR(sim.contacts().at(0).tangential_force_n.norm() / (mu * sim.contacts().at(0).normal_force_n), 1, 1e-9) << mu;
    sim.step(1900);
    EXPECT_NEAR(sim.contacts().at(0).tangential_force_n.norm() / (mu * sim.contacts().at(0).normal_force_n), 1, 1e-9) << mu;  // .975 t: slips still
    sim.step(8100);
    EXPECT_LT(sim.contacts().at(0).tangential_force_n.norm(), .1 * mu * sim.contacts().at(0).normal_force_n) << mu;  // 3 t: rolls
    EXPECT_NEAR(sim.grain(0).velocity_m_s.x() / v0, 5. / 7, 5e-3 * 5 / 7) << mu;
    EXPECT_NEAR(sim.grain(0).spin_rad_s.y() * ball.radius / v0, 5. / 7, 5e-3 * 5 / 7) << mu;
  }
}
}  // namespace
}  // namespace venato::dem::verification
