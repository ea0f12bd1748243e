#include "sync/registration/block_sums.h"
#include <algorithm>
#include <numeric>
#include <vector>
#include "base/expects.h"
namespace venato::sync {
namespace {
using Eight = float __attribute__((vector_size(32), aligned(4), may_alias));
const Eight& load(const float* p) { return *reinterpret_cast<const Eight*>(p); }
double total(const Eight& v) {  // a reference: passing vectors by value would depend on the instruction set
  double sum = 0;
  for (int k = 0; k < 8; ++k) sum += static_cast<double>(v[k]);
  return sum;
}
constexpr std::size_t kStepSums = 15;

/// Adds the sums of one row of n pixels (n a multiple of 8); `weight` is 1 where the pixel counts, else 0.
__attribute__((target_clones("avx2", "default"))) void add_step_row(const float* t, const float* weight, const float* w, const float* above,
                                                                    const float* below, int n, double* out) {
  Eight s[kStepSums] = {};
  const Eight half = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
  for (int i = 0; i < n; i += 8) {
    const Eight m = load(weight + i), a = load(t + i) * m, b = load(w + i) * m;
    const Eight gx = (load(w + i + 1) - load(w + i - 1)) * half * m, gy = (load(below + i) - load(above + i)) * half * m;
    s[0] += m;
    s[1] += a;
    s[2] += b;
    s[3] += a * a;
    s[4] += b * b;
    s[5] += a * b;
    s[6] += gx;
    s[7] += gy;
    s[8] += a * gx;
    s[9] += a * gy;
    s[10] += b * gx;
    s[11] += b * gy;
    s[12] += gx * gx;
    s[13] += gx * gy;
    s[14] += gy * gy;
  }
  for (std::size_t k = 0; k < kStepSums; ++k) out[k] += total(s[k]);
}
/// Whether pixel and neighbours are valid, as factors.
__attribute__((target_clones("avx2", "default"))) void weights(const float* block, const float* w, const float* above, const float* below, int n,
                                                               float* out) {
  for (int i = 0; i < n; ++i) out[i] = block[i] * w[i] * w[i - 1] * w[i + 1] * above[i] * below[i];
}
/// Gradient energy between rows a and b; 0 where one of the four pixels is invalid.
__attribute__((target_clones("avx2", "default"))) void energies(const float* a, const float* b, const float* mask_a, const float* mask_b, int n,
                                                                float* out) {
  for (int i = 0; i < n; ++i) {
    const float gx = a[i + 1] - a[i] + b[i + 1] - b[i], gy = b[i] - a[i] + b[i + 1] - a[i + 1];
    out[i] = (gx * gx + gy * gy) * (mask_a[i] * mask_a[i + 1] * mask_b[i] * mask_b[i + 1]);
  }
}
/// out = sums of v and of v * w over n pixels, n a multiple of 8.
__attribute__((target_clones("avx2", "default"))) void two_sums(const float* v, const float* w, int n, double* out) {
  Eight plain = {}, product = {};
  for (int i = 0; i < n; i += 8) {
    plain += load(v + i);
    product += load(v + i) * load(w + i);
  }
  out[0] = total(plain);
  out[1] = total(product);
}
}  // namespace

RectSums row_sums(const float* row, int n) {
  double sums[2];
  const int whole = n / 8 * 8;
  two_sums(row, row, whole, sums);
  for (int i = whole; i < n; ++i) {
    sums[0] += static_cast<double>(row[i]);
    sums[1] += static_cast<double>(row[i] * row[i]);
  }
  return {sums[0], sums[1]};
}

RectSums rect_sums(const Feature& f, int x0, int y0, int x1, int y1) {
  VENATO_EXPECTS(x0 >= 0 && y0 >= 0 && x1 <= f.value.width && y1 <= f.value.height);
  RectSums out;
  for (int y = y0; y < y1; ++y) {
    const RectSums row = row_sums(f.value.data.data() + f.value.index(x0, y), x1 - x0);
    out.sum += row.sum;
    out.squares += row.squares;
  }
  return out;
}

Point energy_centroid(const Patch& block) {
  const int n = block.width - 1;
  std::vector<float> energy(static_cast<std::size_t>(block.stride), 0.0f), place(energy.size());
  std::iota(place.begin(), place.end(), 1.0f);
  double sum = 0, sx = 0, sy = 0;
  for (int j = 0; j + 1 < block.height; ++j) {
    const std::ptrdiff_t a = static_cast<std::ptrdiff_t>(j) * block.stride, b = a + block.stride;
    energies(block.value.data() + a, block.value.data() + b, block.mask.data() + a, block.mask.data() + b, n, energy.data());
    double sums[2];
    two_sums(energy.data(), place.data(), block.stride, sums);
    sum += sums[0];
    sx += sums[1];
    sy += sums[0] * (j + 1);
  }
  return sum > 0 ? Point(sx / sum, sy / sum) : Point(block.width / 2.0, block.height / 2.0);
}

StepSums step_sums(const Patch& block, const Patch& window, int x0, int y0) {
  VENATO_EXPECTS(block.stride % 8 == 0 && x0 >= 1 && y0 >= 1 && y0 + block.height < window.height && x0 + block.stride < window.stride);
  std::array<double, kStepSums> s{};
  std::vector<float> weight(static_cast<std::size_t>(block.stride), 0.0f);
  for (int j = 0; j < block.height; ++j) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(j + y0) * window.stride + x0, k = static_cast<std::ptrdiff_t>(j) * block.stride;
    const float *mask = window.mask.data() + at, *value = window.value.data() + at;
    weights(block.mask.data() + k, mask, mask - window.stride, mask + window.stride, block.width, weight.data());
    add_step_row(block.value.data() + k, weight.data(), value, value - window.stride, value + window.stride, block.stride, s.data());
  }
  StepSums out{s[0], s[1], s[2], s[3], s[4], s[5], {s[6], s[7]}, {s[8], s[9]}, {s[10], s[11]}, {}};
  out.gg << s[12], s[13], s[13], s[14];
  return out;
}
}  // namespace venato::sync
