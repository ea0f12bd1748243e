#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "tests/line/products/random_operator.h"

using namespace venato;
using namespace venato::line;

namespace {
std::vector<Landing> tracer_cloud(int nz, int per_layer, std::uint64_t seed) {
  std::vector<Landing> landings;
  Rng rng(seed, kTestStream, 77);
  for (int z = 0; z < nz; ++z)
    for (int i = 0; i < per_layer; ++i) {
      const int to = std::clamp(z + static_cast<int>(std::lround(0.8 * rng.normal())), 0, nz - 1);
      landings.push_back({z, to, 1.2 + 0.1 * z + 0.02 * rng.normal(), 0.7e-3 + 2e-3 * rng.normal(), 0.5 + rng.uniform()});
    }
  return landings;
}
}  // namespace

TEST(OperatorFromLandings, KeepsMassMeanAndSymmetry) {
  const auto landings = tracer_cloud(5, 4000, 1);
  const Operator op = operator_from_landings("cloud", landings, 5, 5, 0.005, 0.5e-3, false);
  for (int zin = 0; zin < 5; ++zin) {
    double mass = 0, theta = 0, theta2 = 0, eta2 = 0, w_sum = 0, t_sum = 0, t2_sum = 0, e2_sum = 0;
    for (int zout = 0; zout < 5; ++zout)
      for (int t = 0; t < op.n_theta; ++t)
        for (int e = 0; e < op.n_eta; ++e) {
          const double w = op.weight[op.index(zin, zout, t, e)], at = op.reference_delay_s + op.theta0_s + (t + 0.5) * op.dtheta_s;
          const double side = op.eta0_m + (e + 0.5) * op.deta_m;
          EXPECT_EQ(w, op.weight[op.index(zin, zout, t, op.n_eta - 1 - e)]);
          ASSERT_GE(w, 0);
          mass += w;
          theta += w * at;
          theta2 += w * at * at;
          eta2 += w * side * side;
        }
    for (const Landing& l : landings)
      if (l.zeta_in == zin) {
        w_sum += l.weight;
        t_sum += l.weight * l.theta_s;
        t2_sum += l.weight * l.theta_s * l.theta_s;
        e2_sum += l.weight * l.eta_m * l.eta_m;
      }
    EXPECT_NEAR(mass, 1, 1e-14);
    EXPECT_NEAR(theta, t_sum / w_sum, 1e-12);  // the mean delay is exact whatever the grid
    // Variances are those of the landings: the cloud-in-cell widening (h^2/6 = 4.2e-6 s^2, 4.2e-8 m^2) is taken back; pairs of layers with few
    // landings keep theirs.
    EXPECT_NEAR(theta2 - theta * theta, t2_sum / w_sum - t_sum / w_sum * t_sum / w_sum, 2e-8);
    EXPECT_NEAR(eta2 / (e2_sum / w_sum), 1, 2e-4);
  }
}

TEST(OperatorFromLandings, ReferenceDelayIsTheMassMean) {
  // Layers carry equal mass even if one has three times the tracers.
  const Operator op =
      operator_from_landings("two", {{0, 0, 1.0, 0, 1}, {1, 1, 2.0, 0, 1}, {1, 1, 2.0, 0, 1}, {1, 1, 2.0, 0, 1}}, 2, 2, 0.1, 1e-3, false);
  EXPECT_NEAR(op.reference_delay_s, 1.5, 1e-15);
  EXPECT_EQ(op.n_theta, 11);  // just wide enough: -0.5 … +0.5 s
  EXPECT_EQ(op.n_eta, 1);
}

TEST(OperatorFromLandings, FullBedIsDoublyStochastic) {
  const int nz = 6;
  const Operator op = operator_from_landings("cloud", tracer_cloud(nz, 3000, 2), nz, nz, 0.01, 1e-3, true);
  for (int zout = 0; zout < nz; ++zout) {
    double column = 0;
    for (int zin = 0; zin < nz; ++zin)
      for (std::size_t i = op.index(zin, zout, 0, 0); i < op.index(zin, zout + 1, 0, 0); ++i) column += op.weight[i];
    EXPECT_NEAR(column, 1, 1e-11);
  }
  // The clamp at the first and last layer piles mass up there, so the correction is real and reported.
  EXPECT_GT(op.figures.at("sinkhorn_correction"), 0.01);
  EXPECT_LT(op.figures.at("sinkhorn_correction"), 0.6);
  // Balanced input needs none.
  std::vector<Landing> even;
  for (int z = 0; z < nz; ++z)
    for (int to = 0; to < nz; ++to) even.push_back({z, to, 0.1 * z, 1e-3 * to, 1});
  EXPECT_NEAR(operator_from_landings("even", even, nz, nz, 0.1, 1e-3, true).figures.at("sinkhorn_correction"), 0, 1e-12);
}

TEST(OperatorFromLandings, SaysWhatIsMissing) {
  EXPECT_THROW(operator_from_landings("s", {}, 1, 1, 0.1, 1e-3, false), WorkError);
  EXPECT_THROW(operator_from_landings("s", {{0, 0, 1, 0, 1}}, 2, 2, 0.1, 1e-3, false), WorkError);                  // no layer 1
  EXPECT_THROW(operator_from_landings("s", {{0, 0, 1, 0, 1}, {1, 0, 1, 0, 1}}, 2, 2, 0.1, 1e-3, true), WorkError);  // layer 1 stays empty
  EXPECT_THROW(operator_from_landings("s", {{0, 0, std::nan(""), 0, 1}}, 1, 1, 0.1, 1e-3, false), WorkError);
  EXPECT_THROW(operator_from_landings("s", {{0, 0, 0, 0, 1}, {0, 0, 1e9, 0, 1}}, 1, 1, 0.1, 1e-3, false), WorkError);  // one tracer 30 years late
  // {1/2, 1/2; 1, 0} has no doubly stochastic scaling with that zero pattern: the diagonal entry must vanish, reached only in the limit.
  EXPECT_THROW(operator_from_landings("s", {{0, 0, 1, 0, 1}, {0, 1, 1, 0, 1}, {1, 0, 1, 0, 1}}, 2, 2, 0.1, 1e-3, true), WorkError);
}
