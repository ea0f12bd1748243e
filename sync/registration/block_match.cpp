#include "sync/registration/block_match.h"
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include "base/expects.h"
namespace venato::sync {
namespace {
constexpr double kVeinTexture = 0.25, kMinPeak = 0.2, kMinValid = 0.7;  // registration_print.md 1.3
// Veins that faded to a fifth fall below the source's texture limit and leave whole regions without evidence: they are admitted if they match well.
constexpr double kFadedTexture = 0.08, kFadedPeak = 0.5;
constexpr double kMaxPeak = 0.999;         // v / (1 - v) of identical pictures stays finite
constexpr double kRidgePreference = 0.03;  // along a straight vein all shifts score alike: prefer the smaller one
constexpr double kWeakDirection = 0.05;    // curvature below this share of the strong one: no sub-pixel step along it
constexpr double kMaxStep_px = 1.5;        // a step beyond the neighbouring pixels means that the peak is no peak
constexpr int kLanes = 16;

/// Window around a block with rows padded to whole lanes, so that the inner loop has a fixed summation order on every SIMD width.
struct Patch {
  int width = 0, height = 0, stride = 0;
  std::vector<float> value, mask;
  bool all_valid = true;
  double mask_sum = 0;
};
Patch cut(const Feature& f, int x0, int y0, int width, int height, int row_room) {
  Patch p;
  p.width = width;
  p.height = height;
  p.stride = row_room;
  p.value.assign(static_cast<std::size_t>(p.stride) * static_cast<std::size_t>(height), 0.0f);
  p.mask = p.value;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const int x = x0 + i, y = y0 + j;
      const bool ok = x >= 0 && y >= 0 && x < f.value.width && y < f.value.height && f.valid.at(x, y);
      const auto k = static_cast<std::size_t>(j * p.stride + i);
      if (!ok) {
        p.all_valid = false;
        continue;
      }
      p.value[k] = f.value.at(x, y);
      p.mask[k] = 1;
      p.mask_sum += 1;
    }
  return p;
}

/// sum over the block of a(x, y) * b(x + dx, y + dy); a is padded with zeros to whole lanes.
double lane_dot(const float* a, int a_stride, const float* b, int b_stride, int lanes_width, int height) {
  float lane[kLanes] = {};
  for (int j = 0; j < height; ++j) {
    const float *ra = a + static_cast<std::ptrdiff_t>(j) * a_stride, *rb = b + static_cast<std::ptrdiff_t>(j) * b_stride;
    for (int i = 0; i < lanes_width; i += kLanes)
      for (int k = 0; k < kLanes; ++k) lane[k] += ra[i + k] * rb[i + k];
  }
  double sum = 0;
  for (const float v : lane) sum += static_cast<double>(v);
  return sum;
}

/// NCC for all shifts in [-s, s]^2; NaN where too little of the block is valid or the print is flat.
struct Surface {
  int s = 0;
  std::vector<double> v;
  double at(int dx, int dy) const { return v[static_cast<std::size_t>((dy + s) * (2 * s + 1) + dx + s)]; }
};
Surface ncc_surface(Patch& block, Patch& window, int s, double print_variance_floor) {
  Surface out{s, std::vector<double>(static_cast<std::size_t>((2 * s + 1) * (2 * s + 1)), std::nan(""))};
  const int lanes = block.stride;
  const auto dot = [&](const std::vector<float>& a, const std::vector<float>& b, int dx, int dy) {
    return lane_dot(a.data(), block.stride, b.data() + (dy + s) * window.stride + dx + s, window.stride, lanes, block.height);
  };
  std::vector<float> window_square(window.value.size()), block_square(block.value.size());
  for (std::size_t k = 0; k < window_square.size(); ++k) window_square[k] = window.value[k] * window.value[k];
  for (std::size_t k = 0; k < block_square.size(); ++k) block_square[k] = block.value[k] * block.value[k];
  double block_sum = 0, block_squares = 0;
  for (std::size_t k = 0; k < block_square.size(); ++k) {
    block_sum += static_cast<double>(block.value[k]);
    block_squares += static_cast<double>(block_square[k]);
  }
  const bool whole = block.all_valid && window.all_valid;
  // Box sums of the print by running totals (double, exact enough for 0..1 values); only used when everything is valid.
  const auto table_width = static_cast<std::size_t>(window.width + 1);
  std::vector<double> sums, squares;
  if (whole) {
    sums.assign(table_width * static_cast<std::size_t>(window.height + 1), 0.0);
    squares = sums;
    for (int j = 0; j < window.height; ++j) {
      double row = 0, row_squares = 0;
      for (int i = 0; i < window.width; ++i) {
        row += static_cast<double>(window.value[static_cast<std::size_t>(j * window.stride + i)]);
        row_squares += static_cast<double>(window_square[static_cast<std::size_t>(j * window.stride + i)]);
        const std::size_t below = static_cast<std::size_t>(j + 1) * table_width + static_cast<std::size_t>(i + 1);
        sums[below] = sums[below - table_width] + row;
        squares[below] = squares[below - table_width] + row_squares;
      }
    }
  }
  const auto box = [&](const std::vector<double>& t, int x, int y) {
    const auto index = [&](int i, int j) { return static_cast<std::size_t>(j) * table_width + static_cast<std::size_t>(i); };
    return t[index(x + block.width, y + block.height)] - t[index(x, y + block.height)] - t[index(x + block.width, y)] + t[index(x, y)];
  };
  for (int dy = -s; dy <= s; ++dy)
    for (int dx = -s; dx <= s; ++dx) {
      double n = block.mask_sum, b = block_sum, bb = block_squares, w = 0, ww = 0;
      if (whole) {
        w = box(sums, dx + s, dy + s);
        ww = box(squares, dx + s, dy + s);
      } else {
        n = dot(block.mask, window.mask, dx, dy);
        if (!(n >= kMinValid * block.width * block.height)) continue;
        b = dot(block.value, window.mask, dx, dy);
        bb = dot(block_square, window.mask, dx, dy);
        w = dot(block.mask, window.value, dx, dy);
        ww = dot(block.mask, window_square, dx, dy);
      }
      const double var_b = bb / n - b * b / (n * n), var_w = ww / n - w * w / (n * n);
      if (!(var_b > 0 && var_w > print_variance_floor)) continue;
      const double cross = dot(block.value, window.value, dx, dy) / n - b * w / (n * n);
      out.v[static_cast<std::size_t>((dy + s) * (2 * s + 1) + dx + s)] = cross / std::sqrt(var_b * var_w);
    }
  return out;
}

/// Least-squares quadratic a + b x + c y + d x^2 + e x y + f y^2 on 5 x 5: closed form on the symmetric grid.
struct Quadratic {
  Eigen::Matrix2d hessian;
};
bool fit_quadratic(const Surface& v, int dx, int dy, Quadratic& q) {
  double sxx = 0, sxy = 0, syy = 0;
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x) {
      const double value = v.at(dx + x, dy + y);
      if (!std::isfinite(value)) return false;
      sxx += (x * x - 2) * value;
      syy += (y * y - 2) * value;
      sxy += x * y * value;
    }
  const double d = sxx / 70, f = syy / 70, e = sxy / 100;  // 5 * sum (x^2 - 2)^2 = 70, (sum x^2)^2 = 100
  q.hessian << 2 * d, e, e, 2 * f;
  return true;
}

/// Sub-pixel step from an integer shift: Newton on the NCC itself, with its exact derivative and the Gauss-Newton curvature. The top of a quadratic
/// through the NCC samples is biased, because the NCC of a block is not symmetric about its peak: 0.1-0.2 mm on identical pictures.
bool subpixel_step(const Patch& block, const Patch& window, int x0, int y0, Point& step) {
  double n = 0, t = 0, w = 0, tt = 0, ww = 0, tw = 0;
  Point g = Point::Zero(), tg = Point::Zero(), wg = Point::Zero();
  Eigen::Matrix2d gg = Eigen::Matrix2d::Zero();
  const int stride = window.stride;
  for (int j = 0; j < block.height; ++j)
    for (int i = 0; i < block.width; ++i) {
      const auto at = static_cast<std::size_t>((j + y0) * stride + i + x0), below = at + static_cast<std::size_t>(stride),
                 above = at - static_cast<std::size_t>(stride);
      const auto k = static_cast<std::size_t>(j * block.stride + i);
      if (block.mask[k] * window.mask[at] * window.mask[at - 1] * window.mask[at + 1] * window.mask[above] * window.mask[below] == 0) continue;
      const double a = static_cast<double>(block.value[k]), b = static_cast<double>(window.value[at]);
      const Point slope(static_cast<double>(window.value[at + 1] - window.value[at - 1]) / 2,
                        static_cast<double>(window.value[below] - window.value[above]) / 2);
      n += 1;
      t += a;
      w += b;
      tt += a * a;
      ww += b * b;
      tw += a * b;
      g += slope;
      tg += a * slope;
      wg += b * slope;
      gg += slope * slope.transpose();
    }
  if (n < 16) return false;
  const double var_t = tt - t * t / n, var_w = ww - w * w / n, cov = tw - t * w / n;
  if (!(var_t > 0 && var_w > 0 && cov > 0)) return false;
  const Point cov_t = tg - t / n * g, cov_w = wg - w / n * g;
  // d NCC / d shift = (cov(t, g) - cov(t, w) / var(w) cov(w, g)) / sqrt(var t var w): exactly 0 for identical pictures.
  const Point ascent = (cov_t - cov / var_w * cov_w) * (var_w / cov);
  const Eigen::Matrix2d curvature = gg - g * g.transpose() / n - cov_w * cov_w.transpose() / var_w;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(curvature);
  step = Point::Zero();
  for (int k = 0; k < 2; ++k)
    if (eigen.eigenvalues()(k) > kWeakDirection * eigen.eigenvalues()(1) && eigen.eigenvalues()(1) > 0)
      step += eigen.eigenvectors().col(k) * (eigen.eigenvectors().col(k).dot(ascent) / eigen.eigenvalues()(k));
  return step.allFinite() && step.norm() <= kMaxStep_px;
}

bool locate(const Surface& v, const Patch& block, const Patch& window, double pixel_m, double min_peak, BlockMatch& out) {
  double best = -HUGE_VAL;
  int bx = 0, by = 0;
  for (int dy = -v.s; dy <= v.s; ++dy)
    for (int dx = -v.s; dx <= v.s; ++dx) {
      const double value = v.at(dx, dy) - kRidgePreference * (dx * dx + dy * dy) / (v.s * v.s);
      if (value > best) {  // false for NaN
        best = value;
        bx = dx;
        by = dy;
      }
    }
  if (!std::isfinite(best) || std::abs(bx) > v.s - 2 || std::abs(by) > v.s - 2) return false;
  const double peak = v.at(bx, by);
  if (!(peak >= min_peak)) return false;
  Quadratic q;
  if (!fit_quadratic(v, bx, by, q)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(-q.hessian);  // ascending; positive = falls off
  if (!(eigen.eigenvalues()(1) > 0)) return false;
  Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();
  for (int k = 0; k < 2; ++k) {
    const double bend = eigen.eigenvalues()(k);
    if (bend <= 0) continue;
    const Point direction = eigen.eigenvectors().col(k);
    curvature += bend * direction * direction.transpose();
  }
  Point offset = Point::Zero();
  if (!subpixel_step(block, window, bx + v.s, by + v.s, offset)) return false;
  const double v_peak = std::min(kMaxPeak, peak), pixel_mm = pixel_m * 1e3;
  out.ncc = peak;
  out.shift_m = (Point(bx, by) + offset) * pixel_m;
  out.information = curvature * (v_peak / (1 - v_peak)) / (pixel_mm * pixel_mm);
  return true;
}

/// Gradient energy decides which part of the block a shift speaks for: a vein that crosses a corner measures the corner.
Point energy_centroid(const Patch& block) {
  double sum = 0, sx = 0, sy = 0;
  for (int j = 0; j + 1 < block.height; ++j)
    for (int i = 0; i + 1 < block.width; ++i) {
      const auto k = static_cast<std::size_t>(j * block.stride + i), below = k + static_cast<std::size_t>(block.stride);
      if (block.mask[k] + block.mask[k + 1] + block.mask[below] + block.mask[below + 1] < 3.5f) continue;
      const double gx = static_cast<double>(block.value[k + 1] - block.value[k] + block.value[below + 1] - block.value[below]);
      const double gy = static_cast<double>(block.value[below] - block.value[k] + block.value[below + 1] - block.value[k + 1]);
      const double e = gx * gx + gy * gy;
      sum += e;
      sx += e * (i + 1);
      sy += e * (j + 1);
    }
  return sum > 0 ? Point(sx / sum, sy / sum) : Point(block.width / 2.0, block.height / 2.0);
}
}  // namespace

BlockResult match_blocks(const Feature& green, const Feature& texture, const Feature& print, const BlockSettings& settings, int threads) {
  VENATO_EXPECTS(green.value.width == print.value.width && green.value.height == print.value.height && settings.step_m > 0);
  const double pixel = green.value.pitch_m;
  const int half = std::max(4, static_cast<int>(std::lround(settings.half_m / pixel))),
            s = std::max(4, static_cast<int>(std::lround(settings.search_m / pixel)));
  const int columns = std::max(1, static_cast<int>(std::lround(green.value.width_m() / settings.step_m)));
  const int rows = std::max(1, static_cast<int>(std::lround(green.value.height_m() / settings.step_m)));
  const double texture_deviation = moments(texture).deviation, print_deviation = moments(print).deviation;
  const double variance_floor = 0.01 * print_deviation * print_deviation;

  struct Slot {
    BlockMatch match;
    bool found = false, textured = false;
  };
  std::vector<Slot> slots(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const int count = columns * rows;
#pragma omp parallel for schedule(dynamic, 8) num_threads(threads)
  for (int k = 0; k < count; ++k) {
    const int column = k % columns, row = k / columns;
    const int cx = static_cast<int>((column + 0.5) * green.value.width / columns), cy = static_cast<int>((row + 0.5) * green.value.height / rows);
    // Blocks at the rim are clipped to the slab; the measurement then belongs to the centroid of what is left.
    const int x0 = std::max(0, cx - half), x1 = std::min(green.value.width, cx + half + 1), y0 = std::max(0, cy - half),
              y1 = std::min(green.value.height, cy + half + 1);
    const int stride = (x1 - x0 + kLanes - 1) / kLanes * kLanes;
    Patch block = cut(green, x0, y0, x1 - x0, y1 - y0, stride);
    if (!(block.mask_sum >= kMinValid * block.width * block.height)) continue;
    double sum = 0, texture_sum = 0, texture_squares = 0;
    for (const float v : block.value) sum += static_cast<double>(v);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const double v = static_cast<double>(texture.value.at(x, y));
        texture_sum += v;
        texture_squares += v * v;
      }
    const double mean = sum / block.mask_sum, texture_mean = texture_sum / block.mask_sum;
    const double deviation = std::sqrt(std::max(0.0, texture_squares / block.mask_sum - texture_mean * texture_mean)) / texture_deviation;
    if (!(deviation > kFadedTexture)) continue;
    const bool faded = !(deviation > kVeinTexture);
    Slot& slot = slots[static_cast<std::size_t>(k)];
    const Point centroid = energy_centroid(block);
    // Zero-mean block: the sums below stay small and the float products exact enough.
    for (std::size_t i = 0; i < block.value.size(); ++i) block.value[i] -= block.mask[i] * static_cast<float>(mean);
    Patch window = cut(print, x0 - s, y0 - s, block.width + 2 * s, block.height + 2 * s, stride + 2 * s + 1);
    if (!(window.mask_sum >= kMinValid * block.width * block.height)) continue;
    slot.textured = !faded;
    slot.match.column = column;
    slot.match.row = row;
    slot.match.at_m = (Point(x0, y0) + centroid) * pixel;
    slot.match.faded = faded;
    slot.found = locate(ncc_surface(block, window, s, variance_floor), block, window, pixel, faded ? kFadedPeak : kMinPeak, slot.match);
  }
  BlockResult out;
  for (const Slot& slot : slots) {
    out.textured += slot.textured ? 1 : 0;
    if (slot.found) out.matches.push_back(slot.match);
  }
  return out;
}
}  // namespace venato::sync
