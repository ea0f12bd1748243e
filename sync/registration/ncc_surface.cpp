#include "sync/registration/ncc_surface.h"
#include <algorithm>
#include <array>
#include <cmath>
#include "base/expects.h"
#include "sync/registration/block_sums.h"
namespace venato::sync {
namespace {
constexpr int kAtOnce = 4;  // neighbouring shifts that share the loads of the block

using Eight = float __attribute__((vector_size(32), aligned(4), may_alias));  // GCC/Clang vectors; two SSE registers where there is no AVX2
static_assert(kPatchLanes == 8);

/// out[d] = sum over the block of a(x, y) * b(x + d, y) for d = 0..3; a is padded with zeros to whole lanes.
__attribute__((target_clones("avx2", "default"))) void dots(const float* a, int a_stride, const float* b, int b_stride, int lanes_width, int height,
                                                            double* out) {
  Eight low[kAtOnce] = {}, high[kAtOnce] = {};
  for (int j = 0; j < height; ++j) {
    const float *ra = a + static_cast<std::ptrdiff_t>(j) * a_stride, *rb = b + static_cast<std::ptrdiff_t>(j) * b_stride;
    int i = 0;
    for (; i + 16 <= lanes_width; i += 16) {
      const Eight al = *reinterpret_cast<const Eight*>(ra + i), ah = *reinterpret_cast<const Eight*>(ra + i + 8);
      for (int d = 0; d < kAtOnce; ++d) {
        low[d] += al * *reinterpret_cast<const Eight*>(rb + i + d);
        high[d] += ah * *reinterpret_cast<const Eight*>(rb + i + d + 8);
      }
    }
    if (i == lanes_width) continue;
    const Eight al = *reinterpret_cast<const Eight*>(ra + i);
    for (int d = 0; d < kAtOnce; ++d) low[d] += al * *reinterpret_cast<const Eight*>(rb + i + d);
  }
  for (int d = 0; d < kAtOnce; ++d) {
    double sum = 0;
    for (int k = 0; k < 8; ++k) sum += static_cast<double>(low[d][k]) + static_cast<double>(high[d][k]);
    out[d] = sum;
  }
}

std::vector<float> squares_of(const std::vector<float>& v) {
  std::vector<float> out(v.size());
  for (std::size_t k = 0; k < v.size(); ++k) out[k] = v[k] * v[k];
  return out;
}

/// Sums over the boxes of a window that a block of width x height covers at n x n shifts; double is exact enough for values of 0..1.
class BoxSums {
 public:
  BoxSums() = default;
  BoxSums(const std::vector<float>& v, int stride, int width, int height, int n) : n_(n), sum_(static_cast<std::size_t>(n * n)) {
    const int columns = width + n - 1;
    std::vector<double> column(static_cast<std::size_t>(columns), 0.0);
    const auto add = [&](int row, double sign) {
      const float* const from = v.data() + static_cast<std::ptrdiff_t>(row) * stride;
      for (int i = 0; i < columns; ++i) column[static_cast<std::size_t>(i)] += sign * static_cast<double>(from[i]);
    };
    for (int j = 0; j < height; ++j) add(j, 1);
    for (int y = 0; y < n; ++y) {
      if (y > 0) {
        add(y - 1, -1);
        add(y + height - 1, 1);
      }
      double sum = 0;
      for (int i = 0; i < width; ++i) sum += column[static_cast<std::size_t>(i)];
      for (int x = 0; x < n; ++x) {
        if (x > 0) sum += column[static_cast<std::size_t>(x + width - 1)] - column[static_cast<std::size_t>(x - 1)];
        sum_[static_cast<std::size_t>(y * n + x)] = sum;
      }
    }
  }
  double at(int x, int y) const { return sum_[static_cast<std::size_t>(y * n_ + x)]; }

 private:
  int n_ = 0;
  std::vector<double> sum_;
};
}  // namespace

Patch cut(const Feature& f, int x0, int y0, int width, int height, int row_room) {
  VENATO_EXPECTS(row_room >= width);
  Patch p;
  p.width = width;
  p.height = height;
  p.stride = row_room;
  p.value.assign(static_cast<std::size_t>(p.stride) * static_cast<std::size_t>(height), 0.0f);
  p.mask = p.value;
  const int first = std::max(0, -x0), last = std::min(width, f.value.width - x0);  // columns inside the picture
  int count = 0;
  for (int j = std::max(0, -y0); j < std::min(height, f.value.height - y0) && first < last; ++j) {
    const std::size_t from = f.value.index(x0 + first, y0 + j);
    const float* value = f.value.data.data() + from;
    const std::uint8_t* valid = f.valid.data.data() + from;
    float *to_value = p.value.data() + j * p.stride + first, *to_mask = p.mask.data() + j * p.stride + first;
    std::copy_n(value, last - first, to_value);  // 0 where invalid
    for (int i = 0; i < last - first; ++i) {
      to_mask[i] = valid[i] ? 1.0f : 0.0f;
      count += valid[i] ? 1 : 0;
    }
  }
  p.mask_sum = count;
  p.all_valid = count == width * height;
  return p;
}

Surface ncc_surface(const Patch& block, const Patch& window, int s, double min_valid, double window_variance_floor) {
  VENATO_EXPECTS(block.stride % kPatchLanes == 0 && window.stride >= window_room(block.stride, s) && window.height == block.height + 2 * s);
  const int n = 2 * s + 1;
  Surface out{s, std::vector<double>(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), std::nan(""))};
  const std::vector<float> window_square = squares_of(window.value);
  const bool boxed = block.all_valid;
  const std::vector<float> block_square = boxed && window.all_valid ? std::vector<float>{} : squares_of(block.value);
  double block_sum = 0, block_squares = 0;
  for (int j = 0; j < block.height; ++j) {
    const RectSums row = row_sums(block.value.data() + static_cast<std::ptrdiff_t>(j) * block.stride, block.stride);
    block_sum += row.sum;
    block_squares += row.squares;
  }
  const double area = static_cast<double>(block.width) * block.height;
  // A whole block leaves sums over boxes of the window; only what the window's own holes take from the block's sums needs products.
  const auto boxes = [&](const std::vector<float>& v, bool wanted) {
    return wanted ? BoxSums(v, window.stride, block.width, block.height, n) : BoxSums();
  };
  const BoxSums sums = boxes(window.value, boxed), squares = boxes(window_square, boxed), counts = boxes(window.mask, boxed && !window.all_valid);
  enum Product : std::size_t { kCross, kCount, kBlock, kBlockSquare, kWindow, kWindowSquare };
  std::array<std::array<double, kAtOnce>, 6> of{};
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; x += kAtOnce) {
      const int here = std::min(kAtOnce, n - x);
      const auto fill = [&](Product which, const std::vector<float>& a, const std::vector<float>& b) {
        dots(a.data(), block.stride, b.data() + y * window.stride + x, window.stride, block.stride, block.height, of[which].data());
      };
      bool any = false, holes = false;
      if (boxed) {
        for (int d = 0; d < here; ++d) {
          const auto k = static_cast<std::size_t>(d);
          of[kCount][k] = window.all_valid ? area : counts.at(x + d, y);
          of[kWindow][k] = sums.at(x + d, y);
          of[kWindowSquare][k] = squares.at(x + d, y);
        }
      } else {
        fill(kCount, block.mask, window.mask);
        fill(kWindow, block.mask, window.value);
        fill(kWindowSquare, block.mask, window_square);
      }
      for (int d = 0; d < here; ++d) {
        any = any || of[kCount][static_cast<std::size_t>(d)] >= min_valid * area;
        holes = holes || of[kCount][static_cast<std::size_t>(d)] < block.mask_sum;
      }
      if (!any) continue;
      fill(kCross, block.value, window.value);
      if (holes) {
        fill(kBlock, block.value, window.mask);
        fill(kBlockSquare, block_square, window.mask);
      }
      for (int d = 0; d < here; ++d) {
        const auto k = static_cast<std::size_t>(d);
        const double count = of[kCount][k], b = holes ? of[kBlock][k] : block_sum, bb = holes ? of[kBlockSquare][k] : block_squares;
        const double w = of[kWindow][k], ww = of[kWindowSquare][k];
        if (!(count >= min_valid * area)) continue;
        const double var_b = bb / count - b * b / (count * count), var_w = ww / count - w * w / (count * count);
        if (!(var_b > 0 && var_w > window_variance_floor)) continue;
        out.v[static_cast<std::size_t>(y * n + x + d)] = (of[kCross][k] / count - b * w / (count * count)) / std::sqrt(var_b * var_w);
      }
    }
  return out;
}
}  // namespace venato::sync
