#include "line/chain/belt_jitter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/rng.h"
namespace venato::line {
namespace {
constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kSpectrumCut = 1e-8;  // waves with less than this share of the variance density are left out

struct Share {
  int from;
  double weight;
};
/// shares[to] = which rows send how much of their mass to row `to`.
std::vector<std::vector<Share>> row_shares(const BedGrid& g, const JitterField& field) {
  std::vector<double> edge(static_cast<std::size_t>(g.ny) + 1);
  for (int j = 0; j <= g.ny; ++j) edge[static_cast<std::size_t>(j)] = (j * g.pitch_m + field.displacement_m(j * g.pitch_m)) / g.pitch_m;
  std::vector<std::vector<Share>> shares(static_cast<std::size_t>(g.ny));
  for (int j = 0; j < g.ny; ++j) {
    const double low = edge[static_cast<std::size_t>(j)], high = edge[static_cast<std::size_t>(j) + 1];
    if (!(high > low))
      throw WorkError("belt jitter folds the bed at y = " + std::to_string(j * g.pitch_m) +
                      " m; lower belt_jitter/amplitude_mm or raise correlation_mm");
    double left = 1;
    for (int k = static_cast<int>(std::floor(low)); k < high; ++k) {
      const double w = (k + 1 >= high) ? left : (std::min(high, k + 1.0) - std::max(low, double(k))) / (high - low);
      left -= w;
      if (w > 0) shares[static_cast<std::size_t>(((k % g.ny) + g.ny) % g.ny)].push_back({j, w});
    }
  }
  return shares;
}
}  // namespace

JitterField::JitterField(const BeltJitter& jitter, double strip_length_m, std::uint64_t seed) : length_m_(strip_length_m) {
  if (jitter.amplitude_m <= 0) return;
  std::vector<double> variance;
  double total = 0;
  for (int k = 1;; ++k) {
    const double q = kTwoPi * k / length_m_ * jitter.correlation_m;
    const double density = std::exp(-q * q / 4);
    if (k > 1 && density < kSpectrumCut) break;
    variance.push_back(density);
    total += density;
  }
  for (std::size_t k = 0; k < variance.size(); ++k) {
    Rng rng(seed, stream_id("line/belt_jitter"), k);
    const double amplitude = jitter.amplitude_m * std::sqrt(variance[k] / total);
    cosine_.push_back(amplitude * rng.normal());
    sine_.push_back(amplitude * rng.normal());
  }
}

double JitterField::displacement_m(double y_m) const {
  double sum = 0;
  for (std::size_t k = 0; k < cosine_.size(); ++k) {
    const double phase = kTwoPi * static_cast<double>(k + 1) * y_m / length_m_;
    sum += cosine_[k] * std::cos(phase) + sine_[k] * std::sin(phase);
  }
  return sum;
}

double JitterField::slope(double y_m) const {
  double sum = 0;
  for (std::size_t k = 0; k < cosine_.size(); ++k) {
    const double wave = kTwoPi * static_cast<double>(k + 1) / length_m_;
    sum += wave * (sine_[k] * std::cos(wave * y_m) - cosine_[k] * std::sin(wave * y_m));
  }
  return sum;
}

double JitterField::undo(double y_press_m) const {
  double y = y_press_m;
  if (is_zero()) return y;
  for (int i = 0; i < 50; ++i) {
    const double error = y + displacement_m(y) - y_press_m;
    y -= error / (1 + slope(y));
    if (std::abs(error) < 1e-12) break;
  }
  return y;
}

Bed move_bed(const Bed& bed, const JitterField& field, int threads) {
  if (field.is_zero()) return bed;
  const auto& g = bed.grid;
  const auto shares = row_shares(g, field);
  Bed out = make_bed(g, bed.powders);
  const std::size_t nx = static_cast<std::size_t>(g.nx), ny = static_cast<std::size_t>(g.ny);
  const int planes = static_cast<int>(bed.powders.size()) * g.nz;
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int p = 0; p < planes; ++p) {
    const std::size_t powder = static_cast<std::size_t>(p / g.nz), offset = static_cast<std::size_t>(p % g.nz) * nx * ny;
    for (std::size_t to = 0; to < ny; ++to) {
      double* row = out.mass[powder].data() + offset + to * nx;
      for (const auto& [from, w] : shares[to]) {
        const double* source = bed.mass[powder].data() + offset + static_cast<std::size_t>(from) * nx;
        for (std::size_t i = 0; i < nx; ++i) row[i] += w * source[i];
      }
    }
  }
  return out;
}
}  // namespace venato::line
