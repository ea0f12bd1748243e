#pragma once
/// Random beds and kernels shared by the operator tests.
#include <cmath>
#include <vector>

#include "base/rng.h"
#include "line/products/operator.h"

namespace venato::line {
inline constexpr std::uint64_t kTestStream = stream_id("tests/line/products");

inline Bed random_bed(int nx, int ny, int nz, std::size_t powders, double pitch_m, std::uint64_t seed) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < powders; ++k) names.push_back(std::to_string(k).insert(0, 1, 'p'));
  Bed bed = make_bed({nx, ny, nz, pitch_m, 0}, names);
  for (std::size_t k = 0; k < powders; ++k) {
    Rng rng(seed, kTestStream, k);
    for (double& m : bed.mass[k]) m = rng.uniform();
  }
  return bed;
}

/// Random weights, symmetric across the belt, rows sum to 1; doubly stochastic over the layers: mean over random permutations of layers.
inline Operator random_operator(int nz, int n_theta, int n_eta, double dtheta_s, double deta_m, std::uint64_t seed) {
  Operator op;
  op.stage = std::string("random").append(std::to_string(seed));
  op.nz_in = op.nz_out = nz;
  op.n_theta = n_theta;
  op.n_eta = n_eta;
  op.dtheta_s = dtheta_s;
  op.deta_m = deta_m;
  op.theta0_s = -0.5 * n_theta * dtheta_s;
  op.eta0_m = -0.5 * n_eta * deta_m;
  op.full_bed = true;
  op.weight.assign(op.index(nz, 0, 0, 0), 0.0);
  constexpr int kPermutations = 4;
  Rng rng(seed, kTestStream, 1000);
  for (int p = 0; p < kPermutations; ++p) {
    std::vector<int> to(static_cast<std::size_t>(nz));
    for (int z = 0; z < nz; ++z) to[static_cast<std::size_t>(z)] = z;
    for (int z = nz - 1; z > 0; --z) std::swap(to[static_cast<std::size_t>(z)], to[rng.below(static_cast<std::uint64_t>(z) + 1)]);
    for (int z = 0; z < nz; ++z) {
      std::vector<double> patch(static_cast<std::size_t>(n_theta * n_eta));
      double sum = 0;
      for (double& w : patch) sum += w = rng.uniform();
      for (int t = 0; t < n_theta; ++t)
        for (int e = 0; e < n_eta; ++e) {
          const double a = patch[static_cast<std::size_t>(t * n_eta + e)], b = patch[static_cast<std::size_t>(t * n_eta + n_eta - 1 - e)];
          op.weight[op.index(z, to[static_cast<std::size_t>(z)], t, e)] += 0.5 * (a + b) / sum / kPermutations;
        }
    }
  }
  return op;
}

/// Gaussian in delay and shift, sampled where `centre` of the middle cell is 0: n odd.
inline Operator gaussian_operator(double sigma_theta_s, double sigma_eta_m, double dtheta_s, double deta_m) {
  Operator op;
  op.stage = "gaussian";
  op.dtheta_s = dtheta_s;
  op.deta_m = deta_m;
  const int half_t = static_cast<int>(std::ceil(5 * sigma_theta_s / dtheta_s)), half_e = static_cast<int>(std::ceil(5 * sigma_eta_m / deta_m));
  op.n_theta = 2 * half_t + 1;
  op.n_eta = 2 * half_e + 1;
  op.theta0_s = -0.5 * op.n_theta * dtheta_s;
  op.eta0_m = -0.5 * op.n_eta * deta_m;
  op.weight.assign(op.index(1, 0, 0, 0), 0.0);
  double sum = 0;
  for (int t = -half_t; t <= half_t; ++t)
    for (int e = -half_e; e <= half_e; ++e) {
      const double a = sigma_theta_s > 0 ? t * dtheta_s / sigma_theta_s : 0, b = sigma_eta_m > 0 ? e * deta_m / sigma_eta_m : 0;
      sum += op.weight[op.index(0, 0, t + half_t, e + half_e)] = std::exp(-0.5 * (a * a + b * b));
    }
  for (double& w : op.weight) w /= sum;
  return op;
}

inline double largest_difference(const Bed& a, const Bed& b) {
  double largest = a.grid == b.grid ? 0 : HUGE_VAL;
  for (std::size_t k = 0; k < a.mass.size(); ++k)
    for (std::size_t i = 0; i < a.mass[k].size(); ++i) {
      const double d = std::abs(a.mass[k][i] - b.mass[k][i]);
      if (!(d <= largest)) largest = d;
    }
  return largest;
}
}  // namespace venato::line
