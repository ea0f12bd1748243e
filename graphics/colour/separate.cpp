#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "graphics/colour/ink_model.h"
#include "graphics/graphic.h"
namespace venato::graphics {
namespace {
constexpr int kNodes = 33;

/// Where a sample lies in the table: cell and position within it.
struct Place {
  int cell = 0;
  float fraction = 0;
};
/// Table nodes of one channel: 33 evenly spread samples, the one next to the body's value moved onto it, so that the bare body is a node and
/// needs exactly no ink (the amounts have a kink there: everything lighter is out of gamut).
struct Axis {
  std::array<int, kNodes> node{};
  std::array<Place, 256> place{};
  explicit Axis(int body) {
    for (int k = 0; k < kNodes; ++k) node[static_cast<std::size_t>(k)] = (k * 255 + (kNodes - 1) / 2) / (kNodes - 1);
    int nearest = 0;
    for (int k = 0; k < kNodes; ++k)
      if (std::abs(node[static_cast<std::size_t>(k)] - body) < std::abs(node[static_cast<std::size_t>(nearest)] - body)) nearest = k;
    if (nearest != 0 && nearest != kNodes - 1) node[static_cast<std::size_t>(nearest)] = body;
    for (int v = 0, cell = 0; v < 256; ++v) {
      while (cell < kNodes - 2 && v >= node[static_cast<std::size_t>(cell) + 1]) ++cell;
      const int a = node[static_cast<std::size_t>(cell)], b = node[static_cast<std::size_t>(cell) + 1];
      place[static_cast<std::size_t>(v)] = {cell, static_cast<float>(v - a) / static_cast<float>(b - a)};
    }
  }
};

class SeparationTable {
 public:
  SeparationTable(const InkModel& model, const Srgb8& body, double limit, int most)
      : model_(model), limit_(limit), most_(most), inks_(model.absorb.size()), axis_{Axis(body[0]), Axis(body[1]), Axis(body[2])} {
    std::vector<int> all(inks_);
    std::iota(all.begin(), all.end(), 0);
    table_.resize(static_cast<std::size_t>(kNodes * kNodes * kNodes) * inks_);
#pragma omp parallel for schedule(dynamic, 8)
    for (int k = 0; k < kNodes * kNodes * kNodes; ++k) {
      const Srgb8 colour = {node(0, k / (kNodes * kNodes)), node(1, k / kNodes % kNodes), node(2, k % kNodes)};
      const auto a = solve_inks(model_, target(colour), limit_, most_, all);
      std::transform(a.begin(), a.end(), table_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * inks_),
                     [](double v) { return static_cast<float>(v); });
    }
  }
  /// Tetrahedral interpolation. Source: Kasson, Nin, Plouffe, Hafner, J. Electronic Imaging 4 (1995) 226. `work` holds inks floats.
  void look_up(const std::uint8_t* rgb, float* work, std::uint8_t* out) const {
    const Place p[3] = {axis_[0].place[rgb[0]], axis_[1].place[rgb[1]], axis_[2].place[rgb[2]]};
    constexpr int step[3] = {kNodes * kNodes, kNodes, 1};
    int order[3] = {0, 1, 2};  // by falling fraction: the path of cube edges that encloses the point
    if (p[order[0]].fraction < p[order[1]].fraction) std::swap(order[0], order[1]);
    if (p[order[1]].fraction < p[order[2]].fraction) std::swap(order[1], order[2]);
    if (p[order[0]].fraction < p[order[1]].fraction) std::swap(order[0], order[1]);
    int corner = p[0].cell * step[0] + p[1].cell * step[1] + p[2].cell * step[2];
    const float weight[4] = {1 - p[order[0]].fraction, p[order[0]].fraction - p[order[1]].fraction, p[order[1]].fraction - p[order[2]].fraction,
                             p[order[2]].fraction};
    std::fill_n(work, inks_, 0.0f);
    for (int v = 0; v < 4; ++v) {
      if (v > 0) corner += step[order[v - 1]];
      if (weight[v] == 0) continue;
      const float* node_amounts = table_.data() + static_cast<std::size_t>(corner) * inks_;
      for (std::size_t k = 0; k < inks_; ++k) work[k] += weight[v] * node_amounts[k];
    }
    int used = 0;
    for (std::size_t k = 0; k < inks_; ++k) {
      out[k] = static_cast<std::uint8_t>(work[k] * 255 + 0.5f);
      used += out[k] != 0;
    }
    if (used > most_) solve_with_largest(rgb, work, out);
  }

 private:
  std::uint8_t node(std::size_t axis, int k) const { return static_cast<std::uint8_t>(axis_[axis].node[static_cast<std::size_t>(k)]); }
  Log3 target(const Srgb8& c) const {
    Log3 t;
    for (std::size_t k = 0; k < 3; ++k) t[k] = log_reflectance(c[k]) - model_.body[k];
    return t;
  }
  /// Between nodes that use different inks the mixture has more than allowed: keep the largest ones and solve for this very colour.
  void solve_with_largest(const std::uint8_t* rgb, const float* amounts, std::uint8_t* out) const {
    std::vector<int> kept(inks_);
    std::iota(kept.begin(), kept.end(), 0);
    std::stable_sort(kept.begin(), kept.end(), [&](int a, int b) { return amounts[a] > amounts[b]; });
    kept.resize(static_cast<std::size_t>(most_));
    std::sort(kept.begin(), kept.end());
    const auto a = solve_inks(model_, target({rgb[0], rgb[1], rgb[2]}), limit_, most_, kept);
    for (std::size_t k = 0; k < inks_; ++k) out[k] = static_cast<std::uint8_t>(a[k] * 255 + 0.5);
  }
  const InkModel& model_;
  double limit_;
  int most_;
  std::size_t inks_;
  std::array<Axis, 3> axis_;
  std::vector<float> table_;
};

/// Results of one thread's latest colours: pictures repeat theirs, and colours between nodes with different inks are slow to solve.
class ColourCache {
 public:
  explicit ColourCache(std::size_t inks) : inks_(inks), key_(kEntries, kNoKey), amounts_(kEntries * inks) {}
  template <class Compute>
  const std::uint8_t* get(const Srgb8& c, const Compute& compute) {
    const std::uint32_t key = static_cast<std::uint32_t>(c[0]) << 16 | static_cast<std::uint32_t>(c[1]) << 8 | c[2];
    const std::size_t slot = (key * 2654435761u) >> (32 - kBits);  // Fibonacci hashing
    std::uint8_t* out = amounts_.data() + slot * inks_;
    if (key_[slot] != key) {
      compute(out);
      key_[slot] = key;
    }
    return out;
  }

 private:
  static constexpr int kBits = 17;
  static constexpr std::size_t kEntries = std::size_t{1} << kBits;
  static constexpr std::uint32_t kNoKey = 0xffffffffu;
  std::size_t inks_;
  std::vector<std::uint32_t> key_;
  std::vector<std::uint8_t> amounts_;
};

/// Forward model with one factor per ink, level and colour: no exponentials per pixel.
class Predictor {
 public:
  Predictor(const InkModel& model) {
    for (std::size_t c = 0; c < 3; ++c) body_[c] = std::exp(model.body[c]);
    factor_.resize(model.absorb.size());
    for (std::size_t k = 0; k < factor_.size(); ++k)
      for (int level = 0; level < 256; ++level)
        for (std::size_t c = 0; c < 3; ++c) factor_[k][static_cast<std::size_t>(level)][c] = std::exp(level / 255.0 * model.absorb[k][c]);
  }
  Srgb8 operator()(const std::uint8_t* amounts) const {
    Log3 r = body_;
    for (std::size_t k = 0; k < factor_.size(); ++k)
      if (amounts[k])
        for (std::size_t c = 0; c < 3; ++c) r[c] *= factor_[k][amounts[k]][c];
    return {linear_to_srgb(r[0]), linear_to_srgb(r[1]), linear_to_srgb(r[2])};
  }

 private:
  Log3 body_{};
  std::vector<std::array<Log3, 256>> factor_;
};
}  // namespace

Graphic separate(const Raster8& srgb, const std::vector<Ink>& inks, std::array<std::uint8_t, 3> body_srgb, double total_ink_limit,
                 int max_inks_per_pixel) {
  VENATO_EXPECTS(srgb.channels == 1 || srgb.channels == 3);
  if (inks.empty())
    throw UsageError("an RGB graphic cannot be separated without inks: give each ink's name and the sRGB colour of its fired 100 % patch");
  if (!(total_ink_limit > 0)) throw UsageError("total ink limit must be positive");
  if (max_inks_per_pixel < 1 || max_inks_per_pixel > 3)
    throw UsageError("inks per pixel: " + std::to_string(max_inks_per_pixel) + " is outside [1, 3]");
  const InkModel model = make_ink_model(inks, body_srgb);
  const SeparationTable table(model, body_srgb, total_ink_limit, max_inks_per_pixel);
  const Predictor predict(model);
  Graphic g;
  g.inks = inks;
  g.body_srgb = body_srgb;
  g.separated_without_profile = true;
  const int n = static_cast<int>(inks.size());
  g.ink = Raster8(srgb.width, srgb.height, n, srgb.pitch_m);
  g.srgb = Raster8(srgb.width, srgb.height, 3, srgb.pitch_m);
#pragma omp parallel
  {
    std::vector<float> work(inks.size());
    // Ink amounts and, behind them, the colour they make.
    ColourCache cache(inks.size() + 3);
#pragma omp for schedule(static)
    for (int j = 0; j < srgb.height; ++j)
      for (int i = 0; i < srgb.width; ++i) {
        const std::uint8_t* in = &srgb.at(i, j);
        const Srgb8 rgb = srgb.channels == 3 ? Srgb8{in[0], in[1], in[2]} : Srgb8{in[0], in[0], in[0]};
        const std::uint8_t* made = cache.get(rgb, [&](std::uint8_t* out) {
          table.look_up(rgb.data(), work.data(), out);
          const Srgb8 seen = predict(out);
          std::copy(seen.begin(), seen.end(), out + n);
        });
        std::copy_n(made, n, &g.ink.at(i, j));
        std::copy_n(made + n, 3, &g.srgb.at(i, j));
      }
  }
  return g;
}

namespace {
Srgb8 srgb_of_mixture(const InkModel& model, const std::uint8_t* amounts, double* work) {
  for (std::size_t k = 0; k < model.absorb.size(); ++k) work[k] = amounts[k] / 255.0;
  const Log3 r = mix_log_reflectance(model, work);
  return {linear_to_srgb(std::exp(r[0])), linear_to_srgb(std::exp(r[1])), linear_to_srgb(std::exp(r[2]))};
}
}  // namespace

std::array<std::uint8_t, 3> predict_srgb(const std::vector<Ink>& inks, std::array<std::uint8_t, 3> body_srgb, const std::uint8_t* amounts) {
  std::vector<double> work(inks.size());
  return srgb_of_mixture(make_ink_model(inks, body_srgb), amounts, work.data());
}

Raster8 predict_srgb(const std::vector<Ink>& inks, std::array<std::uint8_t, 3> body_srgb, const Raster8& amounts) {
  VENATO_EXPECTS(amounts.channels == static_cast<int>(inks.size()));
  const InkModel model = make_ink_model(inks, body_srgb);
  std::vector<double> work(inks.size());
  Raster8 out(amounts.width, amounts.height, 3, amounts.pitch_m);
  for (std::size_t in = 0, to = 0; in < amounts.data.size(); in += inks.size(), to += 3) {
    const Srgb8 rgb = srgb_of_mixture(model, amounts.data.data() + in, work.data());
    std::copy(rgb.begin(), rgb.end(), out.data.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return out;
}
}  // namespace venato::graphics
