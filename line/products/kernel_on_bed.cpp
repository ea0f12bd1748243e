#include "line/products/kernel_on_bed.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/expects.h"

namespace venato::line {
namespace {
constexpr double kSnap_cells = 1e-9;     // positions this close to a cell centre are on it: an exact shift stays exact
constexpr double kMassTolerance = 1e-9;  // operators are normalised to rounding; anything more is a corrupt or hand-made kernel
constexpr int kSharpenPasses = 8;

struct Share {
  int cell;
  double weight;
};
struct Line {                              // how each sample of one axis lands on cells
  std::vector<std::vector<Share>> shares;  // [sample]
  std::vector<double> excess;              // [sample] variance added, cells^2
  int first = 0, last = 0;
};

Line deposit_line(int n, double first_position, double step) {
  Line line;
  line.first = 1 << 30;
  line.last = -(1 << 30);
  const int pieces = n == 1 ? 1 : std::max(1, static_cast<int>(std::ceil(std::abs(step) - 1e-9)));  // a lone sample is a point
  for (int i = 0; i < n; ++i) {
    const double centre = first_position + i * step;
    std::vector<Share> shares;
    const auto add = [&](int cell, double w) {
      if (w == 0) return;
      for (Share& s : shares)
        if (s.cell == cell) {
          s.weight += w;
          return;
        }
      shares.push_back({cell, w});
    };
    for (int k = 0; k < pieces; ++k) {
      double at = centre + step * ((k + 0.5) / pieces - 0.5);
      if (std::abs(at - std::round(at)) < kSnap_cells) at = std::round(at);
      const int cell = static_cast<int>(std::floor(at));
      add(cell, (1 - (at - cell)) / pieces);
      add(cell + 1, (at - cell) / pieces);
    }
    double mean = 0, variance = 0;
    for (const Share& s : shares) mean += s.weight * s.cell;
    for (const Share& s : shares) variance += s.weight * (s.cell - mean) * (s.cell - mean);
    for (const Share& s : shares) line.first = std::min(line.first, s.cell), line.last = std::max(line.last, s.cell);
    line.shares.push_back(std::move(shares));
    line.excess.push_back(variance);
  }
  return line;
}

void check(const Operator& op, const std::vector<double>& weight) {
  const std::size_t expected = op.index(op.nz_in, 0, 0, 0);
  const std::string who = "operator '" + op.stage + "': ";
  if (weight.size() != expected)
    throw UsageError(who + std::to_string(weight.size()) + " weights, its grid needs " + std::to_string(expected) + "; characterise the stage again");
  if (op.n_eta > 1 && std::abs(op.eta0_m + 0.5 * op.n_eta * op.deta_m) > 1e-9 * op.n_eta * op.deta_m)
    throw UsageError(who + "its lateral grid is not centred on 0; operators must be symmetric across the belt");
  for (int zin = 0; zin < op.nz_in; ++zin) {
    double row = 0;
    for (std::size_t i = op.index(zin, 0, 0, 0); i < op.index(zin + 1, 0, 0, 0); i += static_cast<std::size_t>(op.n_eta))
      for (int e = 0; e < op.n_eta; ++e) {
        const double w = weight[i + static_cast<std::size_t>(e)], mirror = weight[i + static_cast<std::size_t>(op.n_eta - 1 - e)];
        if (!(w >= 0)) throw UsageError(who + "weight " + std::to_string(w) + " is not a mass (must be >= 0)");
        if (!(std::abs(w - mirror) <= kMassTolerance)) throw UsageError(who + "kernel is not symmetric across the belt");
        row += w;
      }
    if (!(std::abs(row - 1) <= kMassTolerance))
      throw UsageError(who + "layer " + std::to_string(zin) + " keeps " + std::to_string(row) + " of its mass instead of 1");
  }
}
}  // namespace

double sharpen(double* h, int lines, std::size_t line_stride, int n, std::size_t stride, double mass, double excess) {
  std::vector<double> moved(static_cast<std::size_t>(n));
  const auto smallest = [&](const double* line, int i) {
    const std::size_t at = static_cast<std::size_t>(i) * stride;
    return std::min({line[at - stride], line[at], line[at + stride]});
  };
  for (int pass = 0; pass < kSharpenPasses && n >= 3 && excess > 1e-13 && mass > 0; ++pass) {
    double room = 0;
    for (int l = 0; l < lines; ++l)
      for (int i = 1; i + 1 < n; ++i) room += smallest(h + static_cast<std::size_t>(l) * line_stride, i);
    if (room <= 1e-12 * mass) break;
    // Each unit of c removes 2 * room of second moment; two neighbours take c * h_i at most each, so c <= 1/2 keeps h_i >= 0.
    const double c = std::min(0.5, excess * mass / (2 * room));
    for (int l = 0; l < lines; ++l) {
      double* line = h + static_cast<std::size_t>(l) * line_stride;
      for (int i = 1; i + 1 < n; ++i) moved[static_cast<std::size_t>(i)] = c * smallest(line, i);
      for (int i = 1; i + 1 < n; ++i) {
        double* at = line + static_cast<std::size_t>(i) * stride;
        const double m = moved[static_cast<std::size_t>(i)];
        at[0] += 2 * m;
        at[stride] -= m;
        *(at - stride) -= m;
      }
    }
    excess -= 2 * c * room / mass;
  }
  for (int l = 0; l < lines; ++l)  // subtracting two halves of h_i may leave -1e-17
    for (int i = 0; i < n; ++i) {
      double& value = h[static_cast<std::size_t>(l) * line_stride + static_cast<std::size_t>(i) * stride];
      if (value < 0) value = 0;
    }
  return std::max(0.0, excess);
}

BedKernel kernel_on_bed(const Operator& op, const std::vector<double>& weight, double reference_delay_s, double pitch_m, double belt_speed_m_s,
                        double nominal_delay_s) {
  VENATO_EXPECTS(pitch_m > 0 && belt_speed_m_s > 0);
  check(op, weight);
  const double per_second = belt_speed_m_s / pitch_m;
  const Line y =
      deposit_line(op.n_theta, -(reference_delay_s - nominal_delay_s + op.theta0_s + 0.5 * op.dtheta_s) * per_second, -op.dtheta_s * per_second);
  const Line x = op.n_eta == 1 ? deposit_line(1, 0, 0) : deposit_line(op.n_eta, (op.eta0_m + 0.5 * op.deta_m) / pitch_m, op.deta_m / pitch_m);
  const int half = std::max(x.last, -x.first), full = 2 * half + 1;

  BedKernel kernel{op.nz_in, op.nz_out, y.first, y.last - y.first + 1, half + 1, {}};
  const std::size_t pairs = static_cast<std::size_t>(op.nz_in) * static_cast<std::size_t>(op.nz_out);
  const std::size_t rows = static_cast<std::size_t>(kernel.n_y), columns = static_cast<std::size_t>(full);
  kernel.weight.assign(pairs * rows * static_cast<std::size_t>(kernel.n_x), 0.0);
  std::vector<double> patch(rows * columns);
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    std::fill(patch.begin(), patch.end(), 0.0);
    const double* source = weight.data() + pair * static_cast<std::size_t>(op.n_theta) * static_cast<std::size_t>(op.n_eta);
    double mass = 0, excess_y = 0, excess_x = 0;
    for (std::size_t it = 0; it < y.shares.size(); ++it)
      for (std::size_t ie = 0; ie < x.shares.size(); ++ie) {
        const double w = source[it * x.shares.size() + ie];
        if (w == 0) continue;
        mass += w;
        excess_y += w * y.excess[it];
        excess_x += w * x.excess[ie];
        for (const Share& sy : y.shares[it])
          for (const Share& sx : x.shares[ie])
            patch[static_cast<std::size_t>(sy.cell - y.first) * columns + static_cast<std::size_t>(sx.cell + half)] += w * sy.weight * sx.weight;
      }
    if (mass <= 0) continue;
    sharpen(patch.data(), full, 1, kernel.n_y, columns, mass, excess_y / mass);
    sharpen(patch.data(), kernel.n_y, columns, full, 1, mass, excess_x / mass);
    double kept = 0;
    for (double w : patch) kept += w;
    double* out = kernel.weight.data() + pair * rows * static_cast<std::size_t>(kernel.n_x);
    for (std::size_t row = 0; row < rows; ++row)
      for (int e = 0; e <= half; ++e)  // mean of both sides: exactly symmetric
        out[row * static_cast<std::size_t>(kernel.n_x) + static_cast<std::size_t>(e)] =
            0.5 * (patch[row * columns + static_cast<std::size_t>(half + e)] + patch[row * columns + static_cast<std::size_t>(half - e)]) *
            (mass / kept);
  }
  return kernel;
}

BedKernel transposed(const BedKernel& kernel) {
  BedKernel out{kernel.nz_out, kernel.nz_in, -(kernel.y_offset + kernel.n_y - 1), kernel.n_y, kernel.n_x, std::vector<double>(kernel.weight.size())};
  const std::size_t n_x = static_cast<std::size_t>(kernel.n_x), size = static_cast<std::size_t>(kernel.n_y) * n_x;
  for (int zin = 0; zin < kernel.nz_in; ++zin)
    for (int zout = 0; zout < kernel.nz_out; ++zout) {
      double* target = const_cast<double*>(out.pair(zout, zin));
      for (std::size_t i = 0; i < size; ++i) target[i] = kernel.pair(zin, zout)[(static_cast<std::size_t>(kernel.n_y) - 1 - i / n_x) * n_x + i % n_x];
    }
  return out;
}
}  // namespace venato::line
