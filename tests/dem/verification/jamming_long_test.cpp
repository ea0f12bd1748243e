/// Frictionless spheres jam at 64 % with six contacts each (Silbert 2010; O'Hern et al. 2003): a many-body check of packing, forces and neighbour
/// lists.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "tests/dem/verification/scenes.h"

namespace venato::dem::verification {
namespace {
struct Packing {
  double pressure, contacts;  ///< [-] p / Y*, contacts per grain without rattlers
};
/// `n` equal spheres thrown at random into a periodic cube at solid fraction `phi`, overlaps relaxed: velocities are taken away whenever they have
/// turned against the forces as a whole; the unbalanced force must end below 1e-3 of the mean contact force.
Packing quench(double phi, int n, std::uint64_t seed) {
  const Ball ball{1e7, .25, 2000, 1e-3};
  const double side = std::cbrt(n * 4. / 3 * std::numbers::pi / phi) * ball.radius;
  SimulationSetup s = scene::setup(8e-6, alone(ball, {.3, 0, 0, 0}));
  s.box.high = Vec3::Constant(side);
  for (bool& p : s.box.periodic) p = true;
  Simulation sim(s);
  Rng rng(seed, stream_id("tests/jamming"));
  for (int k = 0; k < n; ++k) {
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    sim.add_grain(scene::grain(side * Vec3(x, y, z), ball.radius));
  }
  auto stop = [&] {
    for (const GrainId id : sim.grain_ids()) sim.set_velocity(id, Vec3::Zero(), Vec3::Zero());
  };
  for (int k = 0; k < 60; ++k) sim.step(5), stop();  // random overlaps reach a whole diameter: creep out of them
  for (int k = 0; k < 3000; ++k) {
    sim.step(20);
    double power = 0;
    for (const GrainState& g : sim.grains()) power += g.velocity_m_s.dot(g.force_n);
    if (power < 0) stop();
  }
  double unbalanced = 0, mean = 0, virial = 0;
  std::vector<int> count(static_cast<std::size_t>(n));
  const auto contacts = sim.contacts();
  for (const GrainState& g : sim.grains()) unbalanced += g.force_n.norm() / n;
  for (const ContactState& c : contacts) {
    mean += c.normal_force_n / static_cast<double>(contacts.size());
    virial += c.normal_force_n * (2 * ball.radius - c.overlap_m);
    ++count[static_cast<std::size_t>(c.i)], ++count[static_cast<std::size_t>(c.j)];
  }
  EXPECT_LT(unbalanced, 1e-3 * mean) << phi;
  // Rattlers (fewer than four contacts) go, with what they touched, until none is left.
  std::vector<bool> out(count.size());
  for (bool again = true; again;) {
    again = false;
    for (std::size_t k = 0; k < count.size(); ++k) {
      if (out[k] || count[k] >= 4) continue;
      out[k] = again = true;
      for (const ContactState& c : contacts) {
        const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
        if (i == k && !out[j]) --count[j];
        if (j == k && !out[i]) --count[i];
      }
    }
  }
  double sum = 0, held = 0;
  for (std::size_t k = 0; k < count.size(); ++k) sum += out[k] ? 0 : count[k], held += !out[k];
  return {virial / (3 * side * side * side) / (ball.plane_modulus() / 2), sum / held};
}
/// For Hertz spheres p ~ (phi - phi_J)^1.5, so p^(2/3) against phi is a straight line that meets zero at phi_J: .64 +- .01. The contact number grows
/// from its isostatic value with the root of the distance: Z = Z_0 + c sqrt(phi - phi_J), Z_0 = 6 +- .2. The limits are those of the literature for a
/// thousand spheres. Controls: below jamming (.58) there is no pressure to speak of and no rigid skeleton of six.
TEST(Jamming, FrictionlessSpheres) {
  const double phi[] = {.655, .67, .69};
  Packing p[3];
  double mean_x = 0, mean_y = 0;
  for (int k = 0; k < 3; ++k) {
    p[k] = quench(phi[k], 1000, 1);
    mean_x += phi[k] / 3, mean_y += std::pow(p[k].pressure, 2. / 3) / 3;
  }
  double xy = 0, xx = 0;
  for (int k = 0; k < 3; ++k) xy += (phi[k] - mean_x) * (std::pow(p[k].pressure, 2. / 3) - mean_y), xx += (phi[k] - mean_x) * (phi[k] - mean_x);
  const double phi_j = mean_x - mean_y * xx / xy;
  EXPECT_NEAR(phi_j, .64, .01);
  // straight line of Z against sqrt(phi - phi_J)
  double mx = 0, mz = 0, sxz = 0, sxx = 0;
  for (int k = 0; k < 3; ++k) mx += std::sqrt(phi[k] - phi_j) / 3, mz += p[k].contacts / 3;
  for (int k = 0; k < 3; ++k) {
    const double x = std::sqrt(phi[k] - phi_j) - mx;
    sxz += x * (p[k].contacts - mz), sxx += x * x;
  }
  EXPECT_NEAR(mz - sxz / sxx * mx, 6, .2);
  for (int k = 0; k < 3; ++k) std::printf("phi %.2f  p/Y* %.3e  Z %.3f\n", phi[k], p[k].pressure, p[k].contacts);
  std::printf("phi_J %.4f  Z_0 %.3f\n", phi_j, mz - sxz / sxx * mx);
}
}  // namespace
}  // namespace venato::dem::verification
