#include "sync/registration/block_match.h"
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include "base/expects.h"
#include "sync/registration/block_sums.h"
#include "sync/registration/ncc_surface.h"
namespace venato::sync {
namespace {
constexpr double kVeinTexture = 0.25, kMinPeak = 0.2, kMinValid = 0.7;  // registration_print.md 1.3
// Veins that faded to a fifth fall below the source's texture limit and leave whole regions without evidence: they are admitted if they match well.
constexpr double kFadedTexture = 0.08, kFadedPeak = 0.5;
constexpr double kMaxPeak = 0.999;         // v / (1 - v) of identical pictures stays finite
constexpr double kRidgePreference = 0.03;  // along a straight vein all shifts score alike: prefer the smaller one
constexpr double kWeakDirection = 0.05;    // curvature below this share of the strong one: no sub-pixel step along it
constexpr double kMaxStep_px = 1.5;        // a step beyond the neighbouring pixels means that the peak is no peak

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
  const auto [n, t, w, tt, ww, tw, g, tg, wg, gg] = step_sums(block, window, x0, y0);
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

}  // namespace

BlockResult match_blocks(const Feature& green, const Feature& texture, const Feature& print, const BlockSettings& settings, int threads) {
  VENATO_EXPECTS(green.value.width == print.value.width && green.value.height == print.value.height && settings.step_m > 0);
  const double pixel = green.value.pitch_m;
  const int half = std::max(4, static_cast<int>(std::lround(settings.half_m / pixel))),
            s = std::max(4, static_cast<int>(std::lround(settings.search_m / pixel)));
  const int columns = std::max(1, static_cast<int>(std::lround(green.value.width_m() / settings.step_m)));
  const int rows = std::max(1, static_cast<int>(std::lround(green.value.height_m() / settings.step_m)));
  const double texture_deviation = moments(texture, threads).deviation, print_deviation = moments(print, threads).deviation;
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
    const int stride = (x1 - x0 + kPatchLanes - 1) / kPatchLanes * kPatchLanes;
    Patch block = cut(green, x0, y0, x1 - x0, y1 - y0, stride);
    if (!(block.mask_sum >= kMinValid * block.width * block.height)) continue;
    const RectSums sums = rect_sums(green, x0, y0, x1, y1);
    const auto on_texture = [&](int at, int limit) {
      return std::clamp(static_cast<int>(std::lround(at * pixel / texture.value.pitch_m)), 0, limit);
    };
    const int tx0 = on_texture(x0, texture.value.width), tx1 = on_texture(x1, texture.value.width), ty0 = on_texture(y0, texture.value.height),
              ty1 = on_texture(y1, texture.value.height);
    const RectSums texture_sums = rect_sums(texture, tx0, ty0, tx1, ty1);
    const double mean = sums.sum / block.mask_sum;
    const double texture_count = std::max(1.0, block.mask_sum / (block.width * block.height) * (tx1 - tx0) * (ty1 - ty0));
    const double texture_mean = texture_sums.sum / texture_count;
    const double deviation = std::sqrt(std::max(0.0, texture_sums.squares / texture_count - texture_mean * texture_mean)) / texture_deviation;
    if (!(deviation > kFadedTexture)) continue;
    const bool faded = !(deviation > kVeinTexture);
    Slot& slot = slots[static_cast<std::size_t>(k)];
    const Point centroid = energy_centroid(block);
    // Zero-mean block: the sums below stay small and the float products exact enough.
    for (std::size_t i = 0; i < block.value.size(); ++i) block.value[i] -= block.mask[i] * static_cast<float>(mean);
    Patch window = cut(print, x0 - s, y0 - s, block.width + 2 * s, block.height + 2 * s, window_room(stride, s));
    if (!(window.mask_sum >= kMinValid * block.width * block.height)) continue;
    slot.textured = !faded;
    slot.match.column = column;
    slot.match.row = row;
    slot.match.at_m = (Point(x0, y0) + centroid) * pixel;
    slot.match.faded = faded;
    slot.found = locate(ncc_surface(block, window, s, kMinValid, variance_floor), block, window, pixel, faded ? kFadedPeak : kMinPeak, slot.match);
  }
  BlockResult out;
  for (const Slot& slot : slots) {
    out.textured += slot.textured ? 1 : 0;
    if (slot.found) out.matches.push_back(slot.match);
  }
  return out;
}
}  // namespace venato::sync
