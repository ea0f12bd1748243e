#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/video/tracking.hpp>
#include "sync/registration/ecc_refine.h"
namespace venato::sync {
namespace {
constexpr double kMinSingular = 0.95, kMaxSingular = 1.06;  // registration_print.md 1.3 step 2: springback and belt errors stay inside
constexpr double kSmoothing_px = 0.75;                      // 3 mm at 4 mm/px; the coarse level gets the same in its own pixels
constexpr int kCoarseIterations = 50, kFineIterations = 80;
constexpr double kEpsilon = 1e-6;
constexpr std::size_t kFineCandidates = 2;
constexpr double kSamePlace_m = 0.030;  // half of what the pose search tells apart; ECC reaches farther on its smoothed pictures
constexpr double kSameShape = 0.01;
constexpr double kRivalScore = 0.5;  // the best wrong place had at most 1.48 times the next (registration_print.md 1.5 T2)

cv::Mat as_mat(const Feature& f, float sign) {
  cv::Mat m(f.value.height, f.value.width, CV_32F);
  const auto mean = static_cast<float>(moments(f, 1).mean);
  for (int j = 0; j < f.value.height; ++j)
    for (int i = 0; i < f.value.width; ++i) m.at<float>(j, i) = f.valid.at(i, j) ? sign * (f.value.at(i, j) - mean) : 0;
  return m;
}

double overlap_share(const Feature& green, const Feature& print, const Transform& pose) {
  const Feature seen = warp_to_green(print, pose, green.value.width, green.value.height, 1);
  double both = 0, all = 0;
  for (std::size_t k = 0; k < green.valid.data.size(); ++k)
    if (green.valid.data[k]) {
      all += 1;
      both += seen.valid.data[k] ? 1 : 0;
    }
  return all > 0 ? both / all : 0;
}

std::string number(const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
}  // namespace

RefinedPose refine_affine(const Feature& green, const Feature& print, const Transform& start, int polarity, int iterations, double min_overlap) {
  RefinedPose out;
  out.polarity = polarity;
  const double pitch = green.value.pitch_m;
  // Pixel index = position / pitch - 1/2 on both sides.
  const Point half(0.5, 0.5);
  const Point shift = start.a * half + start.t / pitch - half;
  cv::Mat warp = (cv::Mat_<float>(2, 3) << start.a(0, 0), start.a(0, 1), shift.x(), start.a(1, 0), start.a(1, 1), shift.y());
  const cv::Mat input = as_mat(print, static_cast<float>(polarity)), templ = as_mat(green, 1);
  cv::Mat mask(print.valid.height, print.valid.width, CV_8U);
  std::copy(print.valid.data.begin(), print.valid.data.end(), mask.data);
  try {
    // gaussFiltSize 1: OpenCV's own pre-filter reflects the border and biases the scale (registration_print.md 1.1).
    out.ecc = cv::findTransformECC(templ, input, warp, cv::MOTION_AFFINE,
                                   cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, iterations, kEpsilon), mask, 1);
  } catch (const cv::Exception&) {
    out.why_not = "affine refinement did not converge";
    return out;
  }
  out.pose.a << static_cast<double>(warp.at<float>(0, 0)), static_cast<double>(warp.at<float>(0, 1)), static_cast<double>(warp.at<float>(1, 0)),
      static_cast<double>(warp.at<float>(1, 1));
  const Point moved(static_cast<double>(warp.at<float>(0, 2)), static_cast<double>(warp.at<float>(1, 2)));
  out.pose.t = (moved + half - out.pose.a * half) * pitch;
  if (!std::isfinite(out.ecc) || !out.pose.a.allFinite() || !out.pose.t.allFinite()) {
    out.why_not = "affine refinement diverged";
    return out;
  }
  const Eigen::Vector2d singular = Eigen::JacobiSVD<Eigen::Matrix2d>(out.pose.a).singularValues();
  if (!(singular(1) >= kMinSingular && singular(0) <= kMaxSingular)) {
    out.why_not = "the best affine fit would stretch the picture by " + number("%.3f", singular(1)) + " to " + number("%.3f", singular(0)) +
                  ", outside [0.95, 1.06]: the pictures do not belong together, or mm per pixel of one of them is wrong";
    return out;
  }
  out.overlap = overlap_share(green, print, out.pose);
  if (!(out.overlap >= min_overlap)) {
    out.why_not = "overlap " + number("%.0f %%", 100 * out.overlap) + number(" < %.0f %%", 100 * min_overlap);
    return out;
  }
  out.ok = true;
  return out;
}

RefinedPose refine_poses(const Feature& green, const Feature& print, const std::vector<PoseCandidate>& candidates, int factor_4mm,
                         const RegistrationConfig& config, bool polarity_known, int threads) {
  struct Try {
    Transform start;
    int polarity;
  };
  std::vector<Try> tries;
  const Point centre(green.value.width_m() / 2, green.value.height_m() / 2);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    // The gradient and the signed feature mostly agree on the best place: refine it once. Places far below their feature's best are no rivals.
    const PoseCandidate& c = candidates[k];
    const bool repeated = std::any_of(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(k), [&](const PoseCandidate& o) {
      return o.turn == c.turn && (o.pose(centre) - c.pose(centre)).norm() < kSamePlace_m;
    });
    const double best = std::max_element(candidates.begin(), candidates.end(), [&](const PoseCandidate& l, const PoseCandidate& r) {
                          return std::pair(l.from_gradient == c.from_gradient, l.score) < std::pair(r.from_gradient == c.from_gradient, r.score);
                        })->score;
    if (c.score < kRivalScore * best) continue;
    if (repeated) continue;
    tries.push_back({candidates[k].pose, 1});
    if (!polarity_known) tries.push_back({candidates[k].pose, -1});
  }
  RefinedPose none;
  none.why_not = "no place of the graphic correlates with the slab over the required overlap";
  if (tries.empty()) return none;

  const auto level = [&](const Feature& f, int factor) { return smooth(downsample(f, factor, threads), kSmoothing_px, threads); };
  const Feature green_coarse = level(green, 2 * factor_4mm), print_coarse = level(print, 2 * factor_4mm);
  std::vector<RefinedPose> coarse(tries.size());
  const int count = static_cast<int>(tries.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    coarse[i] = refine_affine(green_coarse, print_coarse, tries[i].start, tries[i].polarity, kCoarseIterations, config.min_overlap);
  }
  std::stable_sort(coarse.begin(), coarse.end(),
                   [](const RefinedPose& l, const RefinedPose& r) { return std::pair(l.ok, l.ecc) > std::pair(r.ok, r.ecc); });
  if (!coarse.front().ok) return coarse.front();
  coarse.erase(std::find_if(coarse.begin(), coarse.end(), [](const RefinedPose& r) { return !r.ok; }), coarse.end());
  // Candidates that ended at one place are one.
  std::vector<RefinedPose> distinct;
  for (const RefinedPose& r : coarse)
    if (std::none_of(distinct.begin(), distinct.end(), [&](const RefinedPose& d) {
          return d.polarity == r.polarity && (d.pose(centre) - r.pose(centre)).norm() < kSamePlace_m && (d.pose.a - r.pose.a).norm() < kSameShape;
        }))
      distinct.push_back(r);
  coarse = std::move(distinct);
  coarse.resize(std::min(coarse.size(), kFineCandidates));

  const Feature green_fine = level(green, factor_4mm), print_fine = level(print, factor_4mm);
  std::vector<RefinedPose> fine(coarse.size());
  const int fine_count = static_cast<int>(coarse.size());
#pragma omp parallel for schedule(static, 1) num_threads(threads)
  for (int k = 0; k < fine_count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    fine[i] = refine_affine(green_fine, print_fine, coarse[i].pose, coarse[i].polarity, kFineIterations, config.min_overlap);
  }
  std::stable_sort(fine.begin(), fine.end(),
                   [](const RefinedPose& l, const RefinedPose& r) { return std::pair(l.ok, l.ecc) > std::pair(r.ok, r.ecc); });
  return fine.front();
}
}  // namespace venato::sync
