#include "graphics/colour/ink_model.h"

#include <algorithm>
#include <cmath>
namespace venato::graphics {
namespace {
// Small enough to shift amounts by less than one level of 255 for any ink that is visible (|absorb| > 0.1), large enough to choose the
// solution with least ink among equals. The least-ink choice is what keeps amounts continuous from colour to colour.
constexpr double kSparsity = 1e-4;
constexpr double kSlack = 1e-12;

double dot(const Log3& a, const Log3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Solves the n x n system (n <= 4) in place by elimination with partial pivoting. \return false when singular
bool eliminate(double m[4][5], int n) {
  for (int c = 0; c < n; ++c) {
    int p = c;
    for (int r = c + 1; r < n; ++r)
      if (std::abs(m[r][c]) > std::abs(m[p][c])) p = r;
    if (std::abs(m[p][c]) < 1e-10) return false;
    if (p != c) std::swap_ranges(m[p], m[p] + n + 1, m[c]);
    for (int r = 0; r < n; ++r) {
      if (r == c) continue;
      const double f = m[r][c] / m[c][c];
      for (int k = c; k <= n; ++k) m[r][k] -= f * m[c][k];
    }
  }
  for (int r = 0; r < n; ++r) m[r][n] /= m[r][r];
  return true;
}

struct Search {
  const InkModel& model;
  const Log3& target;
  double limit;
  double best_cost;
  int best_ink[3] = {};
  double best_amount[3] = {};
  int best_count = 0;

  double cost(const int* ink, const double* a, int n) const {
    Log3 e = {-target[0], -target[1], -target[2]};
    double sum = 0;
    for (int k = 0; k < n; ++k) {
      sum += a[k];
      for (std::size_t c = 0; c < 3; ++c) e[c] += a[k] * model.absorb[static_cast<std::size_t>(ink[k])][c];
    }
    return dot(e, e) + kSparsity * sum;
  }
  /// One face: inks of the bit set `full` at 1, the rest free, perhaps with the total at its limit. Zero amounts are the smaller subsets.
  /// \return whether its minimum lies above an upper bound (or is not unique)
  bool try_face(const int* ink, int n, unsigned full, bool at_limit) {
    int free_ink[3], f = 0;
    Log3 rest = target;
    double used = 0;
    for (int k = 0; k < n; ++k) {
      const Log3& v = model.absorb[static_cast<std::size_t>(ink[k])];
      if (full >> k & 1u) {
        used += 1;
        for (std::size_t c = 0; c < 3; ++c) rest[c] -= v[c];
      } else {
        free_ink[f++] = k;
      }
    }
    double a[3] = {1, 1, 1};
    if (f > 0) {
      double m[4][5] = {};
      for (int r = 0; r < f; ++r) {
        const Log3& v = model.absorb[static_cast<std::size_t>(ink[free_ink[r]])];
        for (int c = 0; c < f; ++c) m[r][c] = dot(v, model.absorb[static_cast<std::size_t>(ink[free_ink[c]])]);
        m[r][at_limit ? f + 1 : f] = dot(v, rest) - kSparsity / 2;
        if (at_limit) m[r][f] = m[f][r] = 1;
      }
      if (at_limit) m[f][f + 1] = limit - used;
      if (!eliminate(m, at_limit ? f + 1 : f)) return true;
      for (int r = 0; r < f; ++r) a[free_ink[r]] = m[r][at_limit ? f + 1 : f];
    } else if (at_limit) {
      return true;
    }
    double sum = 0;
    bool above = false, below = false;
    for (int k = 0; k < n; ++k) {
      above = above || !(a[k] <= 1 + kSlack);
      below = below || !(a[k] >= -kSlack);
      sum += a[k];
    }
    above = above || !(sum <= limit + 1e-9);
    if (above || below) return above;
    for (int k = 0; k < n; ++k) a[k] = std::clamp(a[k], 0.0, 1.0);
    const double c = cost(ink, a, n);
    if (!(c < best_cost - kSlack)) return false;
    best_cost = c;
    best_count = n;
    std::copy_n(ink, n, best_ink);
    std::copy_n(a, n, best_amount);
    return false;
  }
  void try_subset(const int* ink, int n) {
    // Towards the free minimum the cost falls, so an optimum held by upper bounds alone needs one that the free minimum violates; one
    // held by a zero belongs to a smaller subset.
    if (!try_face(ink, n, 0, false)) return;
    try_face(ink, n, 0, true);
    for (unsigned full = 1; full < (1u << n); ++full) {
      try_face(ink, n, full, false);
      try_face(ink, n, full, true);
    }
  }
};
}  // namespace

double log_reflectance(std::uint8_t srgb) { return std::log(std::max(srgb_to_linear(srgb), kReflectanceFloor)); }

InkModel make_ink_model(const std::vector<Ink>& inks, const Srgb8& body) {
  InkModel m;
  for (std::size_t c = 0; c < 3; ++c) m.body[c] = log_reflectance(body[c]);
  for (const auto& ink : inks) {
    Log3 a;
    for (std::size_t c = 0; c < 3; ++c) a[c] = log_reflectance(ink.solid_srgb[c]) - m.body[c];
    m.absorb.push_back(a);
  }
  return m;
}

Log3 mix_log_reflectance(const InkModel& model, const double* amounts) {
  Log3 r = model.body;
  for (std::size_t k = 0; k < model.absorb.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) r[c] += amounts[k] * model.absorb[k][c];
  return r;
}

std::vector<double> solve_inks(const InkModel& model, const Log3& target, double limit, int most, const std::vector<int>& allowed) {
  Search s{model, target, limit, dot(target, target)};
  const int n = static_cast<int>(allowed.size());
  const auto ink_at = [&](int k) { return allowed[static_cast<std::size_t>(k)]; };
  for (int i = 0; i < n; ++i) {
    int subset[3] = {ink_at(i), 0, 0};
    s.try_subset(subset, 1);
    for (int j = i + 1; most >= 2 && j < n; ++j) {
      subset[1] = ink_at(j);
      s.try_subset(subset, 2);
      for (int k = j + 1; most >= 3 && k < n; ++k) {
        subset[2] = ink_at(k);
        s.try_subset(subset, 3);
      }
    }
  }
  std::vector<double> amounts(model.absorb.size(), 0.0);
  for (int k = 0; k < s.best_count; ++k) amounts[static_cast<std::size_t>(s.best_ink[k])] = s.best_amount[k];
  return amounts;
}
}  // namespace venato::graphics
