#include "sync/registration/nonrigid.h"
#include <algorithm>
#include <cmath>
#include "base/error.h"
namespace venato::sync {
namespace {
struct Level {
  int factor;
  double half_m, search_m, spacing_m, lambda;
};
constexpr Level kLevels[] = {
    {4, 0.096, 0.040, 0.160, 0.005}, {2, 0.064, 0.020, 0.100, 0.01}, {2, 0.048, 0.012, 0.064, 0.02}, {1, 0.028, 0.006, 0.048, 0.03}};
constexpr int kPassesPerLevel = 2;
constexpr int kSharpnessFactor = 3;     // sharpness is compared at 3 mm/px
constexpr double kFullSize_m = 0.6;     // the table of the source was found on slabs of 0.7 m and more
constexpr double kSmallestScale = 0.4;  // blocks of 11 mm half width: below, one vein no longer fits
constexpr double kRobust_m = 0.0015;
constexpr double kMinJacobian = 0.5, kMaxJacobian = 2;
constexpr int kMaxDoublings = 3;

constexpr double kTextureSmoothing_m = 0.003;
// Powder spreads a vein by some mm, the graphic is sharp: unequal sharpness biases the peaks of curved veins by 1-2 mm (measured at 8 mm).
constexpr double kBlurs_m[] = {0.002, 0.003, 0.004, 0.006, 0.008, 0.011, 0.015};
constexpr double kBlurGain = 0.01;  // smoothing the slab always gains a little by removing noise: ask for more than that

double ncc(const Feature& a, const Feature& b) {
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::size_t k = 0; k < a.value.data.size(); ++k) {
    if (!a.valid.data[k] || !b.valid.data[k]) continue;
    const double x = static_cast<double>(a.value.data[k]), y = static_cast<double>(b.value.data[k]);
    n += 1;
    sa += x;
    sb += y;
    saa += x * x;
    sbb += y * y;
    sab += x * y;
  }
  const double va = n * saa - sa * sa, vb = n * sbb - sb * sb;
  return va > 0 && vb > 0 ? (n * sab - sa * sb) / std::sqrt(va * vb) : 0;
}

/// How much more the print (or the slab) must be smoothed so that both are equally sharp.
struct Sharpness {
  double blur_print_m = 0, blur_green_m = 0;
};
Sharpness equal_sharpness(const Feature& green, const Feature& warped) {
  Sharpness best;
  const double pixel = green.value.pitch_m, plain = ncc(green, warped);
  double best_print = plain, best_green = plain + kBlurGain;
  for (const double blur : kBlurs_m) {
    if (const double v = ncc(green, smooth(warped, blur / pixel)); v > best_print) {
      best_print = v;
      best.blur_print_m = blur;
    }
    if (const double v = ncc(smooth(green, blur / pixel), warped); v > best_green) {
      best_green = v;
      best.blur_green_m = blur;
    }
  }
  (best_print >= best_green ? best.blur_green_m : best.blur_print_m) = 0;
  return best;
}

void rescale_information(std::vector<Observation>& observations) {
  std::vector<double> traces;
  for (const Observation& o : observations) traces.push_back(o.information.trace());
  if (traces.empty()) return;
  std::nth_element(traces.begin(), traces.begin() + static_cast<std::ptrdiff_t>(traces.size() / 2), traces.end());
  const double median = traces[traces.size() / 2];
  if (!(median > 0)) return;
  for (Observation& o : observations) o.information *= 2 / median;
}
std::vector<Observation> observe(const std::vector<BlockMatch>& blocks, const BSplineField& u) {
  std::vector<Observation> out;
  // slab(p) = print(T(p + d)), T(q) = A (q + u(q)) + t, so the total displacement wanted at p is d + u(p + d).
  for (const BlockMatch& b : blocks) out.push_back({b.at_m, b.shift_m + u.displacement(b.at_m + b.shift_m), b.information});
  rescale_information(out);
  return out;
}
}  // namespace

NonrigidResult fit_nonrigid(const Feature& green, const Feature& print, const Transform& start, Context& context, PhaseClock& clock) {
  NonrigidResult out;
  out.map = start;
  const double width = green.value.width_m(), height = green.value.height_m();
  const double scale = std::clamp(std::min(width, height) / kFullSize_m, kSmallestScale, 1.0);
  for (const Level& level : kLevels) {
    Sharpness sharpness;
    if (level.factor <= 2) {  // the first level is coarser than any blur worth matching
      const Feature half_print = downsample(print, kSharpnessFactor), half_green = downsample(green, kSharpnessFactor);
      sharpness = equal_sharpness(half_green, warp_to_green(half_print, out.map, half_green.value.width, half_green.value.height, context.threads));
    }
    clock.lap("equal sharpness");
    const double pixel = green.value.pitch_m * level.factor;
    const Feature green_level = smooth(downsample(green, level.factor), sharpness.blur_green_m / pixel);
    const Feature print_level = smooth(downsample(print, level.factor), sharpness.blur_print_m / pixel);
    const Feature texture = smooth(green_level, kTextureSmoothing_m / pixel);
    clock.lap("level pictures");
    const BSplineField reference = project_field(start.u, make_zero_field(width, height, level.spacing_m * scale));
    const bool last = &level == std::end(kLevels) - 1;
    FitSettings fit{level.lambda, std::max(kRobust_m, green_level.value.pitch_m), 4};
    for (int pass = 0; pass < kPassesPerLevel; ++pass) {
      if (context.stop_requested()) throw Interrupted("registration stopped");
      const double search = std::max(3 * green_level.value.pitch_m, (pass == 0 ? 1.0 : 0.5) * level.search_m);
      const BlockSettings settings{level.half_m * scale, level.spacing_m * scale / 2, search};
      const Feature warped = warp_to_green(print_level, out.map, green_level.value.width, green_level.value.height, context.threads);
      clock.lap("warps");
      BlockResult blocks = match_blocks(green_level, texture, warped, settings, context.threads);
      clock.lap(level.factor == 1 ? "block matching at 1 mm" : "block matching coarser");
      std::vector<Observation> observations = observe(blocks.matches, out.map.u);
      BSplineField previous = out.map.u;
      for (int doubling = 0;; ++doubling) {
        FitResult result = fit_spline(observations, reference, fit);
        out.map.u = result.u;
        out.normal_matrix = std::move(result.normal_matrix);
        out.jacobian = jacobian_range(out.map.u, width, height, out.map.u.spacing_m / 4);
        if (out.jacobian.min > kMinJacobian && out.jacobian.max < kMaxJacobian) break;
        if (doubling == kMaxDoublings) {
          out.folded = true;
          return out;
        }
        fit.lambda *= 2;
      }
      clock.lap("spline fits");
      if (last && pass + 1 == kPassesPerLevel) {
        std::vector<Observation> fitted;
        for (std::size_t k = 0; k < observations.size(); ++k) {
          out.held_out.push_back((blocks.matches[k].column + 2 * blocks.matches[k].row) % 5 == 0);
          if (!out.held_out.back()) fitted.push_back(observations[k]);
        }
        out.held_out_field = fit_spline(fitted, reference, fit).u;
        out.blocks = std::move(blocks.matches);
        out.observations = std::move(observations);
        out.textured = blocks.textured;
        out.last_level = settings;
        out.blur_print_m = sharpness.blur_print_m;
        out.blur_green_m = sharpness.blur_green_m;
        clock.lap("spline fits");
      }
    }
  }
  return out;
}
}  // namespace venato::sync
