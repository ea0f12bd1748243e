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

/// How much more the print (or the slab) must be smoothed so that both are equally sharp.
struct Sharpness {
  double blur_print_m = 0, blur_green_m = 0;
};
Sharpness equal_sharpness(const Feature& green, const Feature& warped, int threads) {
  Sharpness best;
  const double pixel = green.value.pitch_m, plain = masked_ncc(green, warped, threads);
  double best_print = plain, best_green = plain + kBlurGain;
  // The NCC has one peak over the blur: two steps down in a row end the search.
  const auto climb = [&](const Feature& blurred, const Feature& other, double& best_ncc, double& best_blur) {
    int down = 0;
    for (const double blur : kBlurs_m) {
      const double v = masked_ncc(other, smooth(blurred, blur / pixel, threads), threads);
      if (v > best_ncc) {
        best_ncc = v;
        best_blur = blur;
        down = 0;
      } else if (++down == 2) {
        return;
      }
    }
  };
  climb(warped, green, best_print, best.blur_print_m);
  climb(green, warped, best_green, best.blur_green_m);
  (best_print >= best_green ? best.blur_green_m : best.blur_print_m) = 0;
  return best;
}

/// The picture of one level, in `room` unless it is f or its half itself.
const Feature& level_picture(const Feature& f, const Feature& half, int factor, double blur_px, int threads, Feature& room) {
  const Feature& base = factor == 1 ? f : half;
  if (factor <= 2 && !(blur_px > 0)) return base;
  room = factor > 2 ? downsample(base, factor / 2, threads) : smooth(base, blur_px, threads);
  if (factor > 2 && blur_px > 0) room = smooth(room, blur_px, threads);
  return room;
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
  const Feature small_green = downsample(green, kSharpnessFactor, context.threads), small_print = downsample(print, kSharpnessFactor, context.threads);
  const Feature half_green = downsample(green, 2, context.threads), half_print = downsample(print, 2, context.threads);
  const Feature texture = smooth(half_green, kTextureSmoothing_m / half_green.value.pitch_m, context.threads);
  clock.lap("level pictures");
  for (const Level& level : kLevels) {
    Sharpness sharpness;
    if (level.factor <= 2)  // the first level is coarser than any blur worth matching
      sharpness = equal_sharpness(small_green, warp_to_green(small_print, out.map, small_green.value.width, small_green.value.height, context.threads),
                                  context.threads);
    clock.lap("equal sharpness");
    const double pixel = green.value.pitch_m * level.factor;
    Feature reduced_green, reduced_print;
    const Feature& green_level = level_picture(green, half_green, level.factor, sharpness.blur_green_m / pixel, context.threads, reduced_green);
    const Feature& print_level = level_picture(print, half_print, level.factor, sharpness.blur_print_m / pixel, context.threads, reduced_print);
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
