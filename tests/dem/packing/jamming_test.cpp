/// Frictionless jamming: verification.md 8 (phi = 0.64, Z = 6). O'Hern et al. 2003 (Phys. Rev. E 68, 011306) give for monodisperse harmonic spheres
/// in three dimensions, without rattlers: Z - 6 = 7.7 (phi - phi_J)^0.5 and pressure, i.e. mean overlap, linear in phi - phi_J.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "dem/packing/pack_dense.h"
#include "dem/packing/relax.h"

namespace venato::dem {
namespace {
constexpr std::size_t kSpheres = 1000;
const Box kBox{Vec3::Zero(), Vec3::Ones(), {true, true, true}};

double radius_at(double fraction) { return std::cbrt(3 * fraction / (4 * std::numbers::pi * static_cast<double>(kSpheres))); }

struct Jammed {
  bool balanced;
  double mean_overlap;  ///< of the diameter, over contacts
  Coordination z;
  std::vector<Vec3> at;
};
Jammed quench(const std::vector<Vec3>& start, double fraction) {
  SoftSpheres spheres(kBox, start, std::vector<double>(kSpheres, radius_at(fraction)), 0, 1);
  const RelaxReport r = relax(spheres, {1e-12, 60'000, 1e-10});  // net forces 1e-5 of the contact forces: contacts no longer come and go
  const auto pairs = spheres.near_pairs(0);
  const double rms = std::sqrt(2 * r.energy / static_cast<double>(std::max<std::size_t>(1, pairs.size()))) / (2 * radius_at(fraction));
  return {r.balanced, rms, coordination_of(kSpheres, pairs), spheres.positions_m()};
}
}  // namespace

TEST(Jamming, FractionAndContactsOfFrictionlessSpheres) {
  std::vector<Vec3> start;
  Rng rng(20, 1);
  for (std::size_t k = 0; k < kSpheres; ++k) {
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    start.emplace_back(x, y, z);
  }
  const Jammed dense = quench(start, 0.66);
  ASSERT_TRUE(dense.balanced);
  // Swelling ends where overlaps end: extrapolated along one packing that keeps its contacts (decompression).
  const Jammed less = quench(dense.at, 0.655);
  ASSERT_TRUE(less.balanced);
  const double slope = (dense.mean_overlap - less.mean_overlap) / 0.005;
  ASSERT_GT(slope, 0);
  const double phi_j = 0.655 - less.mean_overlap / slope;
  EXPECT_NEAR(phi_j, 0.64, 0.01);  // verification.md 8

  // O'Hern's law 0.001 above the estimate (Z = 6.24), +-0.2 (verification.md 8): the estimate's own error moves Z by less than 0.1.
  const Jammed edge = quench(quench(less.at, phi_j + 0.004).at, phi_j + 0.001);
  ASSERT_TRUE(edge.balanced);
  EXPECT_NEAR(edge.z.backbone, 6 + 7.7 * std::sqrt(0.001), 0.2);
  EXPECT_LT(edge.z.rattlers, 0.06);  // 1.5 to 3 % in the literature
  EXPECT_NEAR(dense.z.backbone, 6 + 7.7 * std::sqrt(0.66 - phi_j), 0.2);

  // Below jamming nothing is in contact in the end.
  SoftSpheres loose(kBox, start, std::vector<double>(kSpheres, radius_at(0.60)), 1e-3, 1);
  EXPECT_TRUE(relax(loose, {1e-9, 20'000, 0}).reached);
}
}  // namespace venato::dem
