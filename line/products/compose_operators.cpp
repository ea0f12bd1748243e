#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "line/products/operator.h"

namespace venato::line {
namespace {

bool same(double a, double b) { return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b)); }

// A one-layer operator acts on each layer alike: written out for nz layers.
Operator spread_over_layers(const Operator& op, int nz) {
  if (op.nz_in != 1 || op.nz_out != 1 || nz == 1) return op;
  Operator out = op;
  out.nz_in = out.nz_out = nz;
  const auto spread = [&](const std::vector<double>& from) {
    std::vector<double> to(from.size() * static_cast<std::size_t>(nz) * static_cast<std::size_t>(nz), 0.0);
    for (int z = 0; z < nz; ++z) std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(out.index(z, z, 0, 0)));
    return to;
  };
  out.weight = spread(op.weight);
  for (auto& replicate : out.replicates) replicate = spread(replicate);
  return out;
}

std::vector<double> convolve(const Operator& shape, const Operator& second, const std::vector<double>& w2, const Operator& first,
                             const std::vector<double>& w1) {
  std::vector<double> out(shape.index(shape.nz_in, 0, 0, 0), 0.0);
  for (int zin = 0; zin < first.nz_in; ++zin)
    for (int mid = 0; mid < first.nz_out; ++mid)
      for (int t1 = 0; t1 < first.n_theta; ++t1)
        for (int e1 = 0; e1 < first.n_eta; ++e1) {
          const double w = w1[first.index(zin, mid, t1, e1)];
          if (w == 0) continue;
          for (int zout = 0; zout < second.nz_out; ++zout)
            for (int t2 = 0; t2 < second.n_theta; ++t2) {
              const double* from = w2.data() + second.index(mid, zout, t2, 0);
              double* to = out.data() + shape.index(zin, zout, t1 + t2, e1);
              for (int e2 = 0; e2 < second.n_eta; ++e2) to[e2] += w * from[e2];
            }
        }
  return out;
}
}  // namespace

Operator compose(const Operator& second_in, const Operator& first_in) {
  const Operator second = spread_over_layers(second_in, first_in.nz_out), first = spread_over_layers(first_in, second_in.nz_in);
  const std::string names = "'" + second.stage + "' after '" + first.stage + "'";
  if (second.nz_in != first.nz_out)
    throw UsageError(names + ": " + std::to_string(first.nz_out) + " layers come out, " + std::to_string(second.nz_in) + " are expected");
  if ((first.n_theta > 1 && second.n_theta > 1 && !same(first.dtheta_s, second.dtheta_s)) ||
      (first.n_eta > 1 && second.n_eta > 1 && !same(first.deta_m, second.deta_m)))
    throw UsageError(names + ": kernels have different grids (" + std::to_string(first.dtheta_s) + " s x " + std::to_string(first.deta_m) +
                     " m and " + std::to_string(second.dtheta_s) + " s x " + std::to_string(second.deta_m) + " m)");
  if (!first.replicates.empty() && !second.replicates.empty() && first.replicates.size() != second.replicates.size())
    throw UsageError(names + ": " + std::to_string(first.replicates.size()) + " and " + std::to_string(second.replicates.size()) +
                     " bootstrap replicates");

  Operator out;
  out.stage = first.stage + "+" + second.stage;
  out.nz_in = first.nz_in;
  out.nz_out = second.nz_out;
  out.n_theta = first.n_theta + second.n_theta - 1;
  out.n_eta = first.n_eta + second.n_eta - 1;
  // A single sample has a position but no width worth keeping.
  out.dtheta_s = first.n_theta > 1 ? first.dtheta_s : second.dtheta_s;
  out.deta_m = first.n_eta > 1 ? first.deta_m : second.deta_m;
  const double theta_centre = first.theta0_s + 0.5 * first.dtheta_s + second.theta0_s + 0.5 * second.dtheta_s;
  const double eta_centre = first.eta0_m + 0.5 * first.deta_m + second.eta0_m + 0.5 * second.deta_m;
  out.theta0_s = theta_centre - 0.5 * out.dtheta_s;
  out.eta0_m = eta_centre - 0.5 * out.deta_m;
  out.reference_delay_s = first.reference_delay_s + second.reference_delay_s;
  out.full_bed = first.full_bed && second.full_bed;
  out.weight = convolve(out, second, second.weight, first, first.weight);
  for (std::size_t r = 0; r < std::max(first.replicates.size(), second.replicates.size()); ++r) {
    const bool has1 = !first.replicates.empty(), has2 = !second.replicates.empty();
    out.replicates.push_back(convolve(out, second, has2 ? second.replicates[r] : second.weight, first, has1 ? first.replicates[r] : first.weight));
    out.replicate_reference_delay_s.push_back((has1 ? first.replicate_reference_delay_s[r] : first.reference_delay_s) +
                                              (has2 ? second.replicate_reference_delay_s[r] : second.reference_delay_s));
  }
  for (const Operator* part : {&first, &second}) {
    for (const auto& [name, value] : part->figures) out.figures[part->stage + "." + name] = value;
    for (const auto& [name, value] : part->curves) out.curves[part->stage + "." + name] = value;
    for (const auto& warning : part->warnings) out.warnings.push_back(part->stage + ": " + warning);
  }
  // Values only: both strings are canonical JSON already, or empty.
  out.provenance_json = "{\"first\":" + (first.provenance_json.empty() ? "null" : first.provenance_json) +
                        ",\"second\":" + (second.provenance_json.empty() ? "null" : second.provenance_json) + "}";
  return out;
}
}  // namespace venato::line
