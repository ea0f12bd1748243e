/// Solitary wave in a Hertzian chain: neighbour lists, pair forces, no damping. 80 steel beads R = 4 mm, E = 200 GPa, nu = .3, 7800 kg/m3; the first
/// has v0.
#include <gtest/gtest.h>

#include <array>

#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
const Ball kSteel{2e11, .3, 7800, 4e-3};
constexpr int kBeads = 80, kEarly = 35, kLate = 65;  // contacts between which the wave is timed: formed, and not yet at the end
struct Wave {
  double speed, force;
};
/// From the times at which the force of contact kEarly and kLate peaks (parabola through the highest three samples).
class Peak {
 public:
  void add(double t, double f) {
    if (last_[1] > best_ && last_[1] >= f && last_[1] > last_[0]) {
      const double bend = last_[0] - 2 * last_[1] + f, off = bend < 0 ? .5 * (last_[0] - f) / bend : 0;
      best_ = last_[1], time = t - dt_ + off * dt_, force = last_[1] - .25 * (last_[0] - f) * off;
    }
    last_ = {last_[1], f};
  }
  explicit Peak(double dt) : dt_(dt) {}
  double time = std::nan(""), force = std::nan("");

 private:
  double dt_, best_ = 0;
  std::array<double, 2> last_{};
};
double duration(double v0) { return hertz_duration(kSteel.mass() / 2, kSteel.radius / 2, kSteel.plane_modulus() / 2, v0); }

Wave engine_wave(double v0) {
  const double dt = duration(v0) / 400;
  Simulation sim(scene::setup(dt, alone(kSteel, {1, .3, 0, 0})));
  for (int k = 0; k < kBeads; ++k) sim.add_grain(scene::grain(Vec3(2 * k * kSteel.radius, 0, 0), kSteel.radius, Vec3(k == 0 ? v0 : 0, 0, 0)));
  Peak early(dt), late(dt);
  for (int k = 0; k * dt < .9 * kBeads * 2 * kSteel.radius / (422.76 * std::pow(v0 / .1, .2)); ++k) {
    sim.step();
    double f[2] = {};
    for (const ContactState& c : sim.contacts())
      if (c.i == kEarly)
        f[0] = c.normal_force_n;
      else if (c.i == kLate)
        f[1] = c.normal_force_n;
    early.add(sim.time_s(), f[0]), late.add(sim.time_s(), f[1]);
  }
  return {(kLate - kEarly) * 2 * kSteel.radius / (late.time - early.time), late.force};
}
/// The same chain by a bare loop; `r_eff` in radii: 1/2 is right, 1 is the wall's formula.
Wave loop_wave(double v0, double r_eff) {
  const double dt = duration(v0) / 400, k_h = 4. / 3 * kSteel.plane_modulus() / 2 * std::sqrt(r_eff * kSteel.radius);
  std::array<double, kBeads> x{}, v{}, f{};
  v[0] = v0;
  Peak early(dt), late(dt);
  for (int k = 1; k * dt < .9 * kBeads * 2 * kSteel.radius / (422.76 * std::pow(v0 / .1, .2)); ++k) {
    for (std::size_t i = 0; i < kBeads; ++i) v[i] += .5 * dt / kSteel.mass() * f[i], x[i] += dt * v[i];
    f.fill(0);
    std::array<double, kBeads> push{};
    for (std::size_t i = 0; i + 1 < kBeads; ++i) {
      push[i] = x[i] > x[i + 1] ? k_h * std::pow(x[i] - x[i + 1], 1.5) : 0;
      f[i] -= push[i], f[i + 1] += push[i];
    }
    for (std::size_t i = 0; i < kBeads; ++i) v[i] += .5 * dt / kSteel.mass() * f[i];
    early.add(k * dt, push[kEarly]), late.add(k * dt, push[kLate]);
  }
  return {(kLate - kEarly) * 2 * kSteel.radius / (late.time - early.time), late.force};
}
/// Published: v0 = .1: 422.76 m/s, 8.4074 N; v0 = 1: 670.03 m/s, 133.249 N; speed ~ v0^(1/5). 0.3 %.
bool as_published(const Wave& w, double speed, double force) {
  return std::abs(w.speed / speed - 1) <= 3e-3 && std::abs(w.force / force - 1) <= 3e-3;
}
TEST(Chain, SolitaryWave) {
  const double table[][3] = {{.1, 422.76, 8.4074}, {1, 670.03, 133.249}};
  double speed[2];
  for (const int k : {0, 1}) {
    const Wave w = engine_wave(table[k][0]);
    EXPECT_TRUE(as_published(w, table[k][1], table[k][2])) << w.speed << " m/s " << w.force << " N";
    EXPECT_TRUE(as_published(loop_wave(table[k][0], .5), table[k][1], table[k][2]));
    EXPECT_FALSE(as_published(loop_wave(table[k][0], 1), table[k][1], table[k][2]));  // negative control
    speed[k] = w.speed;
  }
  EXPECT_NEAR(std::log10(speed[1] / speed[0]), .2, 1e-3);
}
}  // namespace
}  // namespace venato::dem::verification
