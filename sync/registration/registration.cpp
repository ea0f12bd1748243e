#include "sync/registration/registration.h"
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include "base/error.h"
#include "sync/registration/gates.h"
namespace venato::sync {
namespace {
constexpr double kPitch_m = 0.001;    // registration_print.md 0: features at 1 px/mm, never at print resolution
constexpr double kMaxPixels = 2.5e7;  // 5 m x 5 m at 1 mm; larger pictures get a coarser grid
constexpr double kSmallSlab_m = 1.0, kSmallPose_m = 0.004, kPose_m = 0.012;     // grid of the pose search
constexpr double kMinContrastFraction = 0.004, kMinContrastLightness = 0.0015;  // standard deviation that still is a picture of veins
constexpr double kMinIsotropy = 0.02;                                           // structure tensor; straight stripes have < 0.01
constexpr double kMinSide_m = 0.08;                                             // two of the smallest blocks
constexpr int kKeepPerFeature = 3;
constexpr double kStretchStep_m = 0.010;

void check_side(const Evidence& e, const char* name) {
  if (e.value.empty()) return;  // no error of the caller: reported as a result
  const std::string who = std::string("registration, ") + name + ": ";
  if (e.value.channels != 1) throw UsageError(who + "evidence must have 1 channel, has " + std::to_string(e.value.channels));
  if (!(e.value.pitch_m > 0) || !std::isfinite(e.value.pitch_m)) throw UsageError(who + "pitch must be positive and finite (metres per pixel)");
  if (e.value.data.size() != static_cast<std::size_t>(e.value.width) * static_cast<std::size_t>(e.value.height))
    throw UsageError(who + "data size does not match width x height");
  if (!e.valid.empty() && (e.valid.width != e.value.width || e.valid.height != e.value.height || e.valid.channels != 1))
    throw UsageError(who + "the validity mask must have the size of the evidence");
}

std::string text(const char* format, double a, double b = 0) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

/// First reason why this side cannot be registered at all; "" if it can.
std::string unusable(const Evidence& e, const char* name) {
  if (e.value.empty()) return std::string(name) + " picture is empty";
  if (std::min(e.value.width_m(), e.value.height_m()) < kMinSide_m)
    return std::string(name) + text(" picture is only %.0f x %.0f mm: check its mm per pixel", e.value.width_m() * 1e3, e.value.height_m() * 1e3);
  double usable = 0;
  for (std::size_t k = 0; k < e.value.data.size(); ++k) usable += std::isfinite(e.value.data[k]) && (e.valid.empty() || e.valid.data[k]) ? 1 : 0;
  const double share = usable / static_cast<double>(e.value.data.size());
  if (share < 0.1) return std::string(name) + text(" picture has only %.1f %% valid (finite, unmasked) pixels", 100 * share);
  return "";
}

/// Combines an affine correction E in the green frame with a prior map: prior(E p) = A' (p + u'(p)) + t'.
Transform prepend(const Transform& prior, const Transform& e, double width_m, double height_m) {
  Transform out;
  out.a = prior.a * e.a;
  out.t = prior.a * e.t + prior.t;
  if (prior.u.spacing_m <= 0) return out;
  const Eigen::Matrix2d back = e.a.inverse();
  BSplineField moved = make_zero_field(width_m, height_m, prior.u.spacing_m);
  std::vector<Observation> samples;
  const double step = moved.spacing_m / 2;
  for (double y = 0; y <= height_m + step; y += step)
    for (double x = 0; x <= width_m + step; x += step)
      samples.push_back({Point(x, y), back * prior.u.displacement(e.a * Point(x, y) + e.t), Eigen::Matrix2d::Identity()});
  out.u = fit_spline(samples, moved, {1e-4, 1.0, 1}).u;
  return out;
}
/// Pixels of the print that lie on the valid slab under an affine map (a prior's small field does not matter for a 40 mm background).
graphics::Raster8 footprint(const Feature& print, const Feature& green, const Transform& pose, int threads) {
  const Eigen::Matrix2d back = pose.a.inverse();
  const double pitch = print.value.pitch_m;
  graphics::Raster8 out(print.value.width, print.value.height, 1, pitch);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i) {
      const Point p = back * (Point(i + 0.5, j + 0.5) * pitch - pose.t) / pitch;
      if (p.x() >= 0 && p.y() >= 0 && p.x() < green.value.width && p.y() < green.value.height)
        out.at(i, j) = green.valid.at(static_cast<int>(p.x()), static_cast<int>(p.y()));
    }
  return out;
}
}  // namespace

Registration register_veins(const Evidence& green, const Evidence& print, const RegistrationConfig& config, const std::optional<Transform>& prior,
                            Context& context) {
  check_side(green, "slab");
  check_side(print, "graphic");
  Registration out;
  for (const auto& [side, name] : {std::pair(&green, "slab"), std::pair(&print, "graphic")})
    if (const std::string why = unusable(*side, name); !why.empty()) {
      fail(out, {"T0", 0, 0, false, "both pictures can be used"}, why);
      return out;
    }
  const bool as_picture = green.kind == EvidenceKind::picture || print.kind == EvidenceKind::picture, polarity_known = !as_picture;
  const double pixels =
      std::max(green.value.width_m() * green.value.height_m(), print.value.width_m() * print.value.height_m()) / (kPitch_m * kPitch_m);
  const double pitch = kPitch_m * std::max(1.0, std::sqrt(pixels / kMaxPixels));

  PhaseClock clock(out.phases);
  context.progress.begin("registration", 4, "steps");
  const Feature green_base = resample(green, pitch, context.threads), print_base = resample(print, pitch, context.threads);
  clock.lap("rasters");
  const double grain = std::max(wanted_smoothing_m(green_base, context.threads), wanted_smoothing_m(print_base, context.threads));
  const Features green_features = make_features(green_base, as_picture, grain, context.threads),
                 print_features = make_features(print_base, as_picture, grain, context.threads);
  clock.lap("features");
  const double min_contrast = as_picture ? kMinContrastLightness : kMinContrastFraction;
  for (const auto& [f, name] : {std::pair(&green_features, "slab"), std::pair(&print_features, "graphic")}) {
    if (!(f->contrast >= min_contrast)) {
      fail(out, {"T0 contrast", f->contrast, min_contrast, false, "standard deviation of the vein evidence"},
           std::string(name) + text(" picture shows no veins: contrast %.5f < %.5f", f->contrast, min_contrast));
      context.progress.end();
      return out;
    }
  }
  for (const auto& [f, name] : {std::pair(&green_features, "slab"), std::pair(&print_features, "graphic")}) {
    if (!(f->isotropy >= kMinIsotropy)) {
      fail(out, {"T7", f->isotropy, kMinIsotropy, false, "weak / strong direction of the veins"},
           std::string(name) + text(" veins all run along (%.2f, %.2f): ", f->weak_direction.x(), f->weak_direction.y()) +
               "a shift that way cannot be observed" + text(" (isotropy %.4f < %.4f)", f->isotropy, kMinIsotropy));
      context.progress.end();
      return out;
    }
  }
  if (context.stop_requested()) throw Interrupted("registration stopped");
  context.progress.at(1);

  const int factor_4mm = std::max(1, static_cast<int>(std::lround(0.004 / pitch)));
  const bool small = std::min(green.value.width_m(), green.value.height_m()) < kSmallSlab_m;
  const double coarse = config.coarse_pitch_m > 0 ? config.coarse_pitch_m : small ? kSmallPose_m : kPose_m;
  PoseSearch search;
  if (prior) {
    // A predicted map names the place; only what ECC can correct is left open.
    PoseCandidate c;
    search.candidates.push_back(c);
    search.gradient_peak_ratio = search.signed_peak_ratio = 10;
  } else {
    search = search_poses(green_features, print_features, coarse, config, polarity_known, kKeepPerFeature, context.threads);
  }
  if (context.stop_requested()) throw Interrupted("registration stopped");
  context.progress.at(2);
  clock.lap("pose search");

  const int width = green_features.signed_evidence.value.width, height = green_features.signed_evidence.value.height;
  const Feature moved = prior ? warp_to_green(print_features.signed_evidence, *prior, width, height, context.threads) : Feature{};
  const Feature& target = prior ? moved : print_features.signed_evidence;
  const RefinedPose pose =
      refine_poses(green_features.signed_evidence, target, search.candidates, factor_4mm, config, polarity_known, context.threads);
  if (!pose.ok) {
    fail(out, {"T1", pose.ecc, 0, false, "an affine pose exists"}, pose.why_not);
    context.progress.end();
    return out;
  }
  context.progress.at(3);
  clock.lap("affine refinement");

  const Transform start = prior ? prepend(*prior, pose.pose, width * pitch, height * pitch) : pose.pose;
  Feature print_signed = as_picture ? band_pass(print_base, grain, footprint(print_base, green_base, start, context.threads), context.threads)
                                    : print_features.signed_evidence;
  if (pose.polarity < 0)
    for (float& v : print_signed.value.data) v = -v;
  clock.lap("start of the displacement");
  const NonrigidResult fit = fit_nonrigid(green_features.signed_evidence, print_signed, start, context, clock);
  out.pose_only = start;
  out.pose_only.u = {};
  out.print_from_green = fit.map;
  if (fit.folded) {
    fail(out, {"T5 folds", fit.jacobian.min, 0.5, false, "smallest Jacobian"},
         text("the displacement folds (Jacobian %.2f to %.2f, allowed 0.5 to 2) even with eight times the stiffness", fit.jacobian.min,
              fit.jacobian.max));
  } else {
    judge(green_features, search, pose, fit, print_signed, config, start.u, context.threads, out);
    if (out.success) out.stretch = slab_stretch(mean_affine(out.print_from_green, width * pitch, height * pitch, kStretchStep_m));
    clock.lap("gates and error map");
  }
  context.progress.end();
  return out;
}
}  // namespace venato::sync
