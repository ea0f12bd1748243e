#include "line/products/operator_with_replicates.h"

#include <algorithm>
#include <cmath>

#include "base/expects.h"

namespace venato::line {
namespace {
int first_cell(const Operator& op) { return static_cast<int>(std::lround(op.theta0_s / op.dtheta_s + 0.5)); }

/// The same kernel on a larger grid of the same steps.
std::vector<double> widen(const Operator& op, int first, int n_theta, int n_eta) {
  Operator wide = op;
  wide.n_theta = n_theta;
  wide.n_eta = n_eta;
  wide.weight.assign(wide.index(op.nz_in, 0, 0, 0), 0.0);
  const int shift_theta = first_cell(op) - first, shift_eta = (n_eta - op.n_eta) / 2;
  for (int a = 0; a < op.nz_in; ++a)
    for (int b = 0; b < op.nz_out; ++b)
      for (int t = 0; t < op.n_theta; ++t)
        for (int e = 0; e < op.n_eta; ++e) wide.weight[wide.index(a, b, t + shift_theta, e + shift_eta)] = op.weight[op.index(a, b, t, e)];
  return wide.weight;
}
}  // namespace

Operator operator_with_replicates(const std::string& stage, const std::vector<std::vector<Landing>>& sets, int nz_in, int nz_out, double dtheta_s,
                                  double deta_m, bool full_bed) {
  VENATO_EXPECTS(!sets.empty());
  std::vector<Operator> ops;
  for (const auto& set : sets) ops.push_back(operator_from_landings(stage, set, nz_in, nz_out, dtheta_s, deta_m, full_bed));
  int first = first_cell(ops[0]), last = first, n_eta = 1;
  for (const Operator& op : ops) {
    first = std::min(first, first_cell(op));
    last = std::max(last, first_cell(op) + op.n_theta - 1);
    n_eta = std::max(n_eta, op.n_eta);
  }
  Operator out = ops[0];
  for (std::size_t k = 1; k < ops.size(); ++k) {
    out.replicates.push_back(widen(ops[k], first, last - first + 1, n_eta));
    out.replicate_reference_delay_s.push_back(ops[k].reference_delay_s);
  }
  out.weight = widen(ops[0], first, last - first + 1, n_eta);
  out.n_theta = last - first + 1;
  out.n_eta = n_eta;
  out.theta0_s = (first - 0.5) * dtheta_s;
  out.eta0_m = -0.5 * n_eta * deta_m;
  return out;
}
}  // namespace venato::line
