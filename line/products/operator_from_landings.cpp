#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/expects.h"
#include "line/products/kernel_on_bed.h"
#include "line/products/operator.h"
#include "line/products/sinkhorn.h"

namespace venato::line {
namespace {
constexpr double kMaxSamples = 2e8;  // 1.6 GB of weights: a landing far off, not a kernel

struct Cloud {  // cloud-in-cell shares of one coordinate on cells centred at integer * step
  int cell;
  double upper;  // share of cell + 1
};
Cloud cloud(double value, double step) {
  double at = value / step;
  if (std::abs(at - std::round(at)) < 1e-9) at = std::round(at);
  const double cell = std::floor(at);
  return {static_cast<int>(cell), at - cell};
}

void check(const std::string& stage, const std::vector<Landing>& landings, int nz_in, int nz_out) {
  if (landings.empty()) throw WorkError("stage '" + stage + "': no powder landed, so there is no kernel; run the slice longer");
  for (const Landing& l : landings) {
    VENATO_EXPECTS(l.zeta_in >= 0 && l.zeta_in < nz_in && l.zeta_out >= 0 && l.zeta_out < nz_out);
    if (!(l.weight >= 0) || !std::isfinite(l.weight) || !std::isfinite(l.theta_s) || !std::isfinite(l.eta_m))
      throw WorkError("stage '" + stage + "': a landing is not finite (delay " + std::to_string(l.theta_s) + " s, shift " + std::to_string(l.eta_m) +
                      " m, weight " + std::to_string(l.weight) + ")");
  }
}
}  // namespace

Operator operator_from_landings(const std::string& stage, const std::vector<Landing>& landings, int nz_in, int nz_out, double dtheta_s, double deta_m,
                                bool full_bed) {
  VENATO_EXPECTS(nz_in >= 1 && nz_out >= 1 && dtheta_s > 0 && deta_m > 0 && (!full_bed || nz_in == nz_out));
  check(stage, landings, nz_in, nz_out);
  Operator op;
  op.stage = stage;
  op.nz_in = nz_in;
  op.nz_out = nz_out;
  op.full_bed = full_bed;
  double mass = 0, delay = 0;
  std::vector<double> row_mass(static_cast<std::size_t>(nz_in), 0.0);
  for (const Landing& l : landings) {
    mass += l.weight;
    row_mass[static_cast<std::size_t>(l.zeta_in)] += l.weight;
  }
  for (int z = 0; z < nz_in; ++z)
    if (!(row_mass[static_cast<std::size_t>(z)] > 0))
      throw WorkError("stage '" + stage + "': nothing landed from input layer " + std::to_string(z) + " of " + std::to_string(nz_in) +
                      "; run the slice longer or use fewer layers");
  // Every input layer carries the same mass, so the mean delay counts the layers alike, however many tracers each has.
  for (const Landing& l : landings) delay += l.weight / row_mass[static_cast<std::size_t>(l.zeta_in)] * l.theta_s;
  op.reference_delay_s = delay / nz_in;

  int first = 1 << 30, last = -(1 << 30), side = 0;
  double extent_theta = 0, extent_eta = 0;
  for (const Landing& l : landings) {
    extent_theta = std::max(extent_theta, std::abs(l.theta_s - op.reference_delay_s) / dtheta_s);
    extent_eta = std::max(extent_eta, std::abs(l.eta_m) / deta_m);
  }
  if (extent_theta * extent_eta > kMaxSamples || extent_theta > kMaxSamples || extent_eta > kMaxSamples)
    throw WorkError("stage '" + stage + "': landings reach " + std::to_string(extent_theta * dtheta_s) + " s and " +
                    std::to_string(extent_eta * deta_m) + " m away from the mean, too far for a kernel");
  for (const Landing& l : landings) {
    const Cloud t = cloud(l.theta_s - op.reference_delay_s, dtheta_s), e = cloud(std::abs(l.eta_m), deta_m);
    first = std::min(first, t.cell);
    last = std::max(last, t.upper > 0 ? t.cell + 1 : t.cell);
    side = std::max(side, e.upper > 0 ? e.cell + 1 : e.cell);
  }
  op.n_theta = last - first + 1;
  op.n_eta = 2 * side + 1;
  op.dtheta_s = dtheta_s;
  op.deta_m = deta_m;
  op.theta0_s = (first - 0.5) * dtheta_s;
  op.eta0_m = -0.5 * op.n_eta * deta_m;
  if (static_cast<double>(op.n_theta) * op.n_eta * nz_in * nz_out > kMaxSamples)
    throw WorkError("stage '" + stage + "': kernel of " + std::to_string(op.n_theta) + " delays x " + std::to_string(op.n_eta) +
                    " shifts is too large; use a coarser grid");

  op.weight.assign(op.index(nz_in, 0, 0, 0), 0.0);
  const std::size_t pairs = static_cast<std::size_t>(nz_in) * static_cast<std::size_t>(nz_out);
  const std::size_t patch = static_cast<std::size_t>(op.n_theta) * static_cast<std::size_t>(op.n_eta);
  std::vector<double> pair_mass(pairs, 0.0), excess_theta(pairs, 0.0), excess_eta(pairs, 0.0);
  for (const Landing& l : landings) {
    const double w = l.weight / row_mass[static_cast<std::size_t>(l.zeta_in)];
    const Cloud t = cloud(l.theta_s - op.reference_delay_s, dtheta_s), e = cloud(std::abs(l.eta_m), deta_m);
    const std::size_t pair = static_cast<std::size_t>(l.zeta_in) * static_cast<std::size_t>(nz_out) + static_cast<std::size_t>(l.zeta_out);
    pair_mass[pair] += w;
    excess_theta[pair] += w * t.upper * (1 - t.upper);
    excess_eta[pair] += w * e.upper * (1 - e.upper);
    for (int dt = 0; dt <= 1; ++dt)
      for (int de = 0; de <= 1; ++de) {
        const double share = 0.5 * w * (dt ? t.upper : 1 - t.upper) * (de ? e.upper : 1 - e.upper);
        if (share == 0) continue;
        op.weight[op.index(l.zeta_in, l.zeta_out, t.cell + dt - first, side + e.cell + de)] += share;
        op.weight[op.index(l.zeta_in, l.zeta_out, t.cell + dt - first, side - e.cell - de)] += share;
      }
  }
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    if (pair_mass[pair] <= 0) continue;
    double* h = op.weight.data() + pair * patch;
    sharpen(h, op.n_eta, 1, op.n_theta, static_cast<std::size_t>(op.n_eta), pair_mass[pair], excess_theta[pair] / pair_mass[pair]);
    sharpen(h, op.n_theta, static_cast<std::size_t>(op.n_eta), op.n_eta, 1, pair_mass[pair], excess_eta[pair] / pair_mass[pair]);
  }
  if (full_bed) op.figures["sinkhorn_correction"] = balance_layers(stage, nz_in, pair_mass, op.weight);
  // Row sums to 1 and both sides alike, to rounding, whatever happened above.
  for (int z = 0; z < nz_in; ++z) {
    const std::size_t begin = op.index(z, 0, 0, 0), end = op.index(z + 1, 0, 0, 0);
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += op.weight[i];
    for (std::size_t i = begin; i < end; ++i) op.weight[i] /= sum;
  }
  for (std::size_t row = 0; row < op.weight.size(); row += static_cast<std::size_t>(op.n_eta))
    for (std::size_t a = row, b = row + static_cast<std::size_t>(op.n_eta) - 1; a < b; ++a, --b)
      op.weight[a] = op.weight[b] = 0.5 * (op.weight[a] + op.weight[b]);
  return op;
}
}  // namespace venato::line
