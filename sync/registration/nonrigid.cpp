#include "sync/registration/nonrigid.h"
#include <algorithm>
#include <cmath>
#include <exception>
#include "base/error.h"
namespace venato::sync {
namespace {
struct Level {
  int factor;
  double half_m, search_m[2], spacing_m, lambda;  ///< search of the first and the second pass
  int passes;
};
// registration_print.md 1.3 with the first search of levels 2 to 4 narrowed from 20, 12 and 6 mm to what the level before leaves over, and without
// second passes of levels 2 and 3: the next level corrects the same. Lambda of the last level is 0.04 instead of 0.03 because it acts on a fifth of
// the bending only.
constexpr Level kLevels[] = {{4, 0.096, {0.040, 0.020}, 0.160, 0.005, 2},
                             {2, 0.064, {0.014, 0.010}, 0.100, 0.01, 1},
                             {2, 0.048, {0.010, 0.006}, 0.064, 0.02, 1},
                             {1, 0.028, {0.005, 0.003}, 0.048, 0.04, 2}};
constexpr int kSharpnessFactor = 3;     // sharpness is compared at 3 mm/px
constexpr double kFullSize_m = 0.6;     // the table of the source was found on slabs of 0.7 m and more
constexpr double kSmallestScale = 0.4;  // blocks of 11 mm half width: below, one vein no longer fits
constexpr double kRobust_m = 0.0015;
constexpr double kMinJacobian = 0.5, kMaxJacobian = 2;
// Mean TRE median / P95 of six tuning pairs of the bench: share 0 0.122 / 0.401 mm, 0.8 0.113 / 0.367, 1 0.111 / 0.356; but 1 also keeps the third
// level's errors at the rim of pictures (0.32 mm at 99 % for a pure shift).
constexpr double kShareOfFieldSoFar = 0.8;
constexpr int kMaxDoublings = 3;
constexpr int kColdRounds = 4, kWarmRounds = 2, kFinalRounds = 3;  // warm: the first weights come from the pass before

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
/// from + share (to - from). \pre one grid
BSplineField between(BSplineField from, const BSplineField& to, double share) {
  for (std::size_t k = 0; k < from.cx.size(); ++k) {
    from.cx[k] += share * (to.cx[k] - from.cx[k]);
    from.cy[k] += share * (to.cy[k] - from.cy[k]);
  }
  return from;
}
/// Fits out.map.u, doubling lambda while it folds; false if it still does. With `some` observations also out.held_out_field, at the final lambda.
bool fit_without_folds(std::span<const Observation> all, std::span<const Observation> some, const BSplineField& reference,
                       const BSplineField& held_out_reference, bool cold, double width_m, double height_m, FitSettings& settings, int threads,
                       NonrigidResult& out) {
  const BSplineField before = out.map.u;
  for (int doubling = 0;; ++doubling) {
    FitResult whole, part;
    std::exception_ptr failed[2];
    const auto guarded = [&](int which, std::span<const Observation> observations, const BSplineField& towards, FitResult& result) {
      try {  // an exception must not leave a parallel region
        result = fit_spline(observations, towards, settings, cold ? nullptr : &before);
      } catch (...) {
        failed[which] = std::current_exception();
      }
    };
#pragma omp parallel sections num_threads(threads)
    {
#pragma omp section
      guarded(0, all, reference, whole);
#pragma omp section
      if (!some.empty()) guarded(1, some, held_out_reference, part);
    }
    for (const std::exception_ptr& e : failed)
      if (e) std::rethrow_exception(e);
    out.map.u = std::move(whole.u);
    out.weight = std::move(whole.weight);
    out.held_out_field = std::move(part.u);
    out.jacobian = jacobian_range(out.map.u, width_m, height_m, out.map.u.spacing_m / 4);
    if (out.jacobian.min > kMinJacobian && out.jacobian.max < kMaxJacobian) return true;
    if (doubling == kMaxDoublings) {
      out.folded = true;
      return false;
    }
    settings.lambda *= 2;
  }
}
}  // namespace

NonrigidResult fit_nonrigid(const Feature& green, const Feature& print, const Transform& start, Context& context, PhaseClock& clock) {
  NonrigidResult out;
  out.map = start;
  const double width = green.value.width_m(), height = green.value.height_m();
  const double scale = std::clamp(std::min(width, height) / kFullSize_m, kSmallestScale, 1.0);
  const Feature small_green = downsample(green, kSharpnessFactor, context.threads),
                small_print = downsample(print, kSharpnessFactor, context.threads);
  const Feature half_green = downsample(green, 2, context.threads), half_print = downsample(print, 2, context.threads);
  const Feature texture = smooth(half_green, kTextureSmoothing_m / half_green.value.pitch_m, context.threads);
  clock.lap("level pictures");
  BSplineField so_far;
  for (const Level& level : kLevels) {
    Sharpness sharpness;
    if (level.factor <= 2)  // the first level is coarser than any blur worth matching
      sharpness = equal_sharpness(
          small_green, warp_to_green(small_print, out.map, small_green.value.width, small_green.value.height, context.threads), context.threads);
    clock.lap("equal sharpness");
    const double pixel = green.value.pitch_m * level.factor;
    Feature reduced_green, reduced_print;
    const Feature& green_level = level_picture(green, half_green, level.factor, sharpness.blur_green_m / pixel, context.threads, reduced_green);
    const Feature& print_level = level_picture(print, half_print, level.factor, sharpness.blur_print_m / pixel, context.threads, reduced_print);
    clock.lap("level pictures");
    const BSplineField reference = project_field(start.u, make_zero_field(width, height, level.spacing_m * scale));
    const bool last = &level == std::end(kLevels) - 1;
    const bool cold = &level == kLevels;
    FitSettings fit{level.lambda, std::max(kRobust_m, green_level.value.pitch_m), cold ? kColdRounds : kWarmRounds};
    for (int pass = 0; pass < level.passes; ++pass) {
      if (context.stop_requested()) throw Interrupted("registration stopped");
      const double search = std::max(3 * green_level.value.pitch_m, level.search_m[pass]);
      const BlockSettings settings{level.half_m * scale, level.spacing_m * scale / 2, search};
      const Feature warped = warp_to_green(print_level, out.map, green_level.value.width, green_level.value.height, context.threads);
      clock.lap("warps");
      BlockResult blocks = match_blocks(green_level, texture, warped, settings, context.threads);
      clock.lap(level.factor == 1 ? "block matching at 1 mm" : "block matching coarser");
      std::vector<Observation> observations = observe(blocks.matches, out.map.u);
      const bool final_pass = last && pass + 1 == level.passes;
      if (final_pass) fit.rounds = kFinalRounds;
      std::vector<Observation> fitted;
      for (std::size_t k = 0; final_pass && k < observations.size(); ++k) {
        out.held_out.push_back((blocks.matches[k].column + 2 * blocks.matches[k].row) % 5 == 0);
        if (!out.held_out.back()) fitted.push_back(observations[k]);
      }
      // The last level bends towards most of the field so far, not towards the prior: penalised in full, short waves would be flattened (iterated
      // Tikhonov regularisation). The held-out fit must not see a field that its blocks have shaped.
      if (last && pass == 0) so_far = between(reference, project_field(out.map.u, reference), kShareOfFieldSoFar);
      if (!fit_without_folds(observations, fitted, last ? so_far : reference, reference, cold && pass == 0, width, height, fit, context.threads, out))
        return out;
      clock.lap("spline fits");
      if (final_pass) {
        out.blocks = std::move(blocks.matches);
        out.observations = std::move(observations);
        out.textured = blocks.textured;
        out.last_level = settings;
        out.reference = reference;
        out.lambda = fit.lambda;
        out.blur_print_m = sharpness.blur_print_m;
        out.blur_green_m = sharpness.blur_green_m;
      }
    }
  }
  return out;
}
}  // namespace venato::sync
