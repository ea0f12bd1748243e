// The published vectors and limits of the edinburgh elasto-plastic adhesive normal force; its damping, friction and collisions are tested elsewhere.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "dem/contact/eepa/law.h"

namespace venato::dem {
namespace {
constexpr double kTop = 1e-5, kR = 0.25e-3, kDigits = 1e-6;  // multiscale.md 3.1; seven digits

struct NormalContact {
  double exponent, k1, k2, k_adh;
  double plastic_n = 0;
  double force(double overlap) { return Eepa::hysteresis(k1, k2, k_adh, std::pow(overlap, exponent), plastic_n); }
  /// Midpoint rule; error of a corner or of d^1.5 at 0 below 1e-7 of the energies with 2e5 steps.
  double work(double from, double to, int n = 200'000) {
    const double step = (to - from) / n;
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += force(from + (k + 0.5) * step) * step;
    force(to);
    return sum;
  }
};

struct Vector {
  double exponent, k1, k_adh, plastic, minimum, f_min, e_load, e_rec, e_tens;
};
Eepa hertzian() {
  Eepa law{};
  law.young_eff = 1 / (2 * (1 - 0.25 * 0.25) / 10e6);  // E 10 MPa, nu 0.25 both
  law.linear = 0;
  return law;
}
Vector vector_n1() { return {1, 200, 100, 0.8, 0.727273, -7.272727e-4, 1e-8, 2e-9, 2.909091e-9}; }
Vector vector_n15() {
  const double k1 = hertzian().loading_stiffness(kR);
  return {1.5, k1, 0.5 * k1, 0.861774, 0.808720, -1.292929e-3, 1.422222e-8, 2.426926e-9, 4.527261e-9};
}

TEST(EepaVectors, loading_stiffness_of_the_hertzian_vector) {
  EXPECT_NEAR(hertzian().loading_stiffness(kR) / 112437, 1, 4.5e-6);  // six digits printed: half a unit of the last
  EXPECT_NEAR(hertzian().loading_stiffness(kR) * std::pow(kTop, 1.5) / 3.555556e-3, 1, kDigits);
}

TEST(EepaVectors, forces_and_overlaps) {
  for (const Vector& v : {vector_n1(), vector_n15()}) {
    NormalContact c{v.exponent, v.k1, 5 * v.k1, v.k_adh};
    const double top = std::pow(kTop, v.exponent);
    EXPECT_NEAR(c.force(kTop) / (v.k1 * top), 1, 1e-12);
    EXPECT_NEAR(std::pow(c.plastic_n, 1 / v.exponent) / kTop, v.plastic, kDigits);
    const double minimum = std::pow(5 * v.k1 / (5 * v.k1 + v.k_adh) * c.plastic_n, 1 / v.exponent);
    EXPECT_NEAR(minimum / kTop, v.minimum, kDigits);
    EXPECT_NEAR(c.force(minimum) / v.f_min, 1, kDigits);
  }
}

TEST(EepaVectors, energies) {
  for (const Vector& v : {vector_n1(), vector_n15()}) {
    NormalContact c{v.exponent, v.k1, 5 * v.k1, v.k_adh};
    EXPECT_NEAR(c.work(0, kTop) / v.e_load, 1, kDigits);
    const double plastic = std::pow(c.plastic_n, 1 / v.exponent);
    EXPECT_NEAR(c.work(kTop, plastic) / -v.e_rec, 1, kDigits);
    EXPECT_NEAR(c.work(plastic, 0) / v.e_tens, 1, kDigits);
  }
}

TEST(EepaVectors, equal_stiffness_without_adhesion_is_hooke_or_hertz) {
  for (double exponent : {1.0, 1.5}) {
    NormalContact c{exponent, 200, 200, 0};
    for (double d : {1e-6, 5e-5, 3e-6, 1e-9, 2e-5}) EXPECT_NEAR(c.force(d) / (200 * std::pow(d, exponent)), 1, 1e-12);
  }
}

TEST(EepaVectors, reload_meets_the_virgin_curve) {
  for (double exponent : {1.0, 1.5}) {
    NormalContact c{exponent, 200, 1000, 100};
    c.force(1e-5), c.force(0.95e-5);
    EXPECT_NEAR(c.force(1e-5 * (1 - 1e-9)) / (200 * std::pow(1e-5, exponent)), 1, 1e-7);
    EXPECT_NEAR(c.force(1.2e-5) / (200 * std::pow(1.2e-5, exponent)), 1, 1e-12);
  }
}

TEST(EepaVectors, no_closed_cycle_gives_energy) {
  for (double exponent : {1.0, 1.5})
    for (std::uint64_t path = 0; path < 100; ++path) {
      const double k1 = 200 / std::pow(kTop, exponent - 1);
      NormalContact c{exponent, k1, 5 * k1, 0.5 * k1};
      Rng rng(1, stream_id("tests/eepa_vectors"), path);
      double at = 0, in = 0, scale = 0;
      for (int turn = 0; turn < 6; ++turn) {
        const double to = turn == 5 ? 0 : 2 * kTop * rng.uniform();
        in += c.work(at, to, 20'000);
        scale += k1 * std::pow(to, exponent + 1);
        at = to;
      }
      EXPECT_GE(in, -1e-6 * scale) << exponent << " " << path;  // quadrature, see work()
    }
}
}  // namespace
}  // namespace venato::dem
