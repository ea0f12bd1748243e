#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include "sync/registration/pose_search.h"
namespace venato::sync {
namespace {
constexpr double kDistinct_m = 0.060;  // candidates nearer than this are the same place (registration_print.md 1.5 T2)
constexpr int kPeaksPerPose = 6;
constexpr double kAliasSafety = 0.85;       // the turned slab's box is a little wider than the slab
constexpr double kMinVarianceShare = 0.02;  // of the whole picture's variance: below it the overlap shows no veins and NCC is noise

struct Grid {  // one normalised feature on the search grid
  cv::Mat value, square, mask;
};
Grid normalised(const Feature& f) {
  const Moments m = moments(f, 1);
  const auto mean = static_cast<float>(m.mean), scale = static_cast<float>(m.deviation > 0 ? 1 / m.deviation : 0);
  Grid g;
  g.value.create(f.value.height, f.value.width, CV_32F);
  g.mask.create(f.value.height, f.value.width, CV_32F);
  for (int j = 0; j < f.value.height; ++j)
    for (int i = 0; i < f.value.width; ++i) {
      const bool ok = f.valid.at(i, j) != 0;
      g.mask.at<float>(j, i) = ok ? 1.0f : 0.0f;
      g.value.at<float>(j, i) = ok ? (f.value.at(i, j) - mean) * scale : 0.0f;
    }
  g.square = g.value.mul(g.value);
  return g;
}

cv::Mat spectrum(const cv::Mat& m, cv::Size size) {
  cv::Mat padded = cv::Mat::zeros(size, CV_32F);
  m.copyTo(padded(cv::Rect(0, 0, m.cols, m.rows)));
  cv::dft(padded, padded, 0, m.rows);
  return padded;
}
cv::Mat correlate(const cv::Mat& fixed, const cv::Mat& moving) {  // c(d) = sum_q fixed(q + d) moving(q), shifts modulo the size
  cv::Mat out;
  cv::mulSpectrums(fixed, moving, out, 0, true);
  cv::dft(out, out, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return out;
}
struct Spectra {
  cv::Mat value, square, mask;
};

/// The slab feature seen in the print's orientation: out(q) = green(A^-1 (q + corner)).
struct Turned {
  Feature feature;
  Point corner_m;
};
Turned turn(const Feature& green, const Eigen::Matrix2d& a) {
  const double pitch = green.value.pitch_m, w = green.value.width_m(), h = green.value.height_m();
  Point lo(HUGE_VAL, HUGE_VAL), hi(-HUGE_VAL, -HUGE_VAL);
  for (const Point& c : {Point(0, 0), Point(w, 0), Point(0, h), Point(w, h)}) {
    const Point q = a * c;
    lo = lo.cwiseMin(q);
    hi = hi.cwiseMax(q);
  }
  Transform green_from_turned;
  green_from_turned.a = a.inverse();
  green_from_turned.t = green_from_turned.a * lo;
  const Point size = (hi - lo) / pitch;
  return {warp_to_green(green, green_from_turned, static_cast<int>(std::ceil(size.x())), static_cast<int>(std::ceil(size.y())), 1), lo};
}

struct Pose {
  Eigen::Matrix2d a;
  int turn;
};
std::vector<Pose> poses(const RegistrationConfig& config) {
  std::vector<Pose> out;
  const int steps = config.rotation_step_rad > 0 ? static_cast<int>(std::floor(config.max_rotation_rad / config.rotation_step_rad + 1e-6)) : 0;
  for (int flip = 0; flip <= (config.allow_flip ? 1 : 0); ++flip)
    for (int quarter = 0; quarter < 4; ++quarter) {
      if (quarter == 2 && !config.allow_half_turn) continue;
      if (quarter % 2 == 1 && !config.allow_quarter_turns) continue;
      for (const double scale : config.scales)
        for (int k = -steps; k <= steps; ++k) {
          const double angle = quarter * std::numbers::pi / 2 + k * config.rotation_step_rad;
          Eigen::Matrix2d a;
          a << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
          if (flip) a.col(0) *= -1;  // x -> -x in the green frame first
          out.push_back({scale * a, flip * 4 + quarter});
        }
    }
  return out;
}

struct Peak {
  double score, ncc, overlap;
  Point t;
  Point centre;
};

std::vector<Peak> peaks(const cv::Mat& score, const cv::Mat& ncc, const cv::Mat& overlap, cv::Size moving, cv::Size fixed, double pitch,
                        const Turned& turned, Point slab_centre) {
  std::vector<Peak> out;
  cv::Mat work = score.clone();
  const int radius = std::max(1, static_cast<int>(std::lround(kDistinct_m / pitch)));
  const auto wrap = [](int d, int n) { return (d % n + n) % n; };
  for (int k = 0; k < kPeaksPerPose; ++k) {
    double best = 0;
    cv::Point at;
    cv::minMaxLoc(work, nullptr, &best, nullptr, &at);
    if (!(best > 0)) break;
    // Shifts live modulo the FFT size: those beyond the print's last pixel are the negative ones.
    const auto unwrap = [](int d, int limit, int n) { return d < limit ? d : d - n; };
    const int dx = unwrap(at.x, fixed.width, work.cols), dy = unwrap(at.y, fixed.height, work.rows);
    Peak p;
    p.score = best;
    p.ncc = static_cast<double>(ncc.at<float>(at));
    p.overlap = static_cast<double>(overlap.at<float>(at));
    p.t = Point(dx, dy) * pitch - turned.corner_m;
    p.centre = slab_centre + p.t;
    out.push_back(p);
    for (int y = std::max(1 - moving.height, dy - radius); y <= std::min(fixed.height - 1, dy + radius); ++y)
      for (int x = std::max(1 - moving.width, dx - radius); x <= std::min(fixed.width - 1, dx + radius); ++x)
        work.at<float>(wrap(y, work.rows), wrap(x, work.cols)) = 0;
  }
  return out;
}

/// Masked NCC map of one feature; `n` is the overlap count map.
void ncc_maps(const Spectra& fixed, const Spectra& moving, const cv::Mat& n, double full_count, double min_overlap, bool positive_only, cv::Mat& ncc,
              cv::Mat& score, cv::Mat& overlap) {
  const cv::Mat cross = correlate(fixed.value, moving.value), sum_f = correlate(fixed.value, moving.mask),
                sum_ff = correlate(fixed.square, moving.mask), sum_m = correlate(fixed.mask, moving.value),
                sum_mm = correlate(fixed.mask, moving.square);
  ncc = cv::Mat::zeros(n.size(), CV_32F);
  score = cv::Mat::zeros(n.size(), CV_32F);
  overlap = cv::Mat::zeros(n.size(), CV_32F);
  for (int j = 0; j < n.rows; ++j)
    for (int i = 0; i < n.cols; ++i) {
      const double count = static_cast<double>(n.at<float>(j, i));
      if (!(count >= min_overlap * full_count)) continue;
      const double f = static_cast<double>(sum_f.at<float>(j, i)), m = static_cast<double>(sum_m.at<float>(j, i));
      const double var_f = static_cast<double>(sum_ff.at<float>(j, i)) / count - f * f / (count * count);
      const double var_m = static_cast<double>(sum_mm.at<float>(j, i)) / count - m * m / (count * count);
      if (!(var_f > kMinVarianceShare && var_m > kMinVarianceShare)) continue;
      const double r = (static_cast<double>(cross.at<float>(j, i)) / count - f * m / (count * count)) / std::sqrt(var_f * var_m);
      const double share = std::min(1.0, count / full_count);
      ncc.at<float>(j, i) = static_cast<float>(r);
      overlap.at<float>(j, i) = static_cast<float>(share);
      // A chance NCC grows like 1 / sqrt(area): without this factor small overlaps at the rim outrank the truth.
      score.at<float>(j, i) = static_cast<float>((positive_only ? std::max(0.0, r) : std::abs(r)) * std::sqrt(share));
    }
}

struct Found {
  Peak peak;
  std::size_t pose;
};

double pick(std::vector<Found>& found, const std::vector<Pose>& all, int keep, bool gradient, std::vector<PoseCandidate>& out) {
  std::stable_sort(found.begin(), found.end(), [](const Found& l, const Found& r) { return l.peak.score > r.peak.score; });
  std::vector<const Found*> distinct;
  for (const Found& f : found) {
    const bool same = std::any_of(distinct.begin(), distinct.end(), [&](const Found* d) {
      return all[d->pose].turn == all[f.pose].turn && (d->peak.centre - f.peak.centre).norm() < kDistinct_m;
    });
    if (!same) distinct.push_back(&f);
    if (static_cast<int>(distinct.size()) >= std::max(2, keep)) break;
  }
  for (std::size_t k = 0; k < distinct.size() && static_cast<int>(k) < keep; ++k) {
    PoseCandidate c;
    c.pose.a = all[distinct[k]->pose].a;
    c.pose.t = distinct[k]->peak.t;
    c.score = distinct[k]->peak.score;
    c.ncc = distinct[k]->peak.ncc;
    c.overlap = distinct[k]->peak.overlap;
    c.from_gradient = gradient;
    c.turn = all[distinct[k]->pose].turn;
    out.push_back(c);
  }
  if (distinct.empty()) return 0;
  // No second place at all (the overlap rule leaves no room): the peak stands alone.
  return distinct.size() < 2 ? 10 : distinct[0]->peak.score / distinct[1]->peak.score;
}
}  // namespace

PoseSearch search_poses(const Features& green, const Features& print, double pitch_m, const RegistrationConfig& config, bool polarity_known, int keep,
                        int threads) {
  const double fine_m = green.gradient.value.pitch_m;  // twice as coarse as the evidence: factors that end on one grid
  const int factor = std::max(1, static_cast<int>(std::lround(pitch_m / fine_m))),
            evidence_factor = factor * edge_factor(green.signed_evidence.value.pitch_m);
  const auto evidence = [&](const Features& f) { return downsample(f.signed_evidence, evidence_factor, threads); };
  const Feature green_features[2] = {downsample(green.gradient, factor, threads), evidence(green)};
  const Grid print_grids[2] = {normalised(downsample(print.gradient, factor, threads)), normalised(evidence(print))};
  const std::vector<Pose> all = poses(config);
  const double pitch = green_features[0].value.pitch_m;
  const Point slab_centre(green_features[0].value.width_m() / 2, green_features[0].value.height_m() / 2);

  // One FFT size for all poses, so that the print is transformed once.
  int moving_width = 0, moving_height = 0;
  for (const Pose& p : all) {
    const Eigen::Matrix2d extent = p.a.cwiseAbs();
    const Point size = extent * Point(green_features[0].value.width, green_features[0].value.height);
    moving_width = std::max(moving_width, static_cast<int>(std::ceil(size.x())) + 1);
    moving_height = std::max(moving_height, static_cast<int>(std::ceil(size.y())) + 1);
  }
  const cv::Size fixed = print_grids[0].value.size();
  // Shifts that leave less than the overlap asked for may alias: the two places that share a bin still overlap too little together.
  const auto room = [&](int moving) { return static_cast<int>(std::ceil((1 - kAliasSafety * config.min_overlap) * moving)); };
  const auto fft_size = [&](int f, int moving) { return cv::getOptimalDFTSize(std::max({f + room(moving), moving, f})); };
  const cv::Size size(fft_size(fixed.width, moving_width), fft_size(fixed.height, moving_height));
  Spectra print_spectra[2];
  for (int k = 0; k < 2; ++k)
    print_spectra[k] = {spectrum(print_grids[k].value, size), spectrum(print_grids[k].square, size), spectrum(print_grids[k].mask, size)};

  std::vector<std::vector<Peak>> found_per_pose[2];
  found_per_pose[0].resize(all.size());
  found_per_pose[1].resize(all.size());
  const int count = static_cast<int>(all.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (int p = 0; p < count; ++p)
    for (int k = 0; k < 2; ++k) {
      const Turned turned = turn(green_features[k], all[static_cast<std::size_t>(p)].a);
      const Grid grid = normalised(turned.feature);
      const Spectra moving{spectrum(grid.value, size), spectrum(grid.square, size), spectrum(grid.mask, size)};
      const cv::Mat n = correlate(print_spectra[k].mask, moving.mask);
      cv::Mat ncc, score, overlap;
      ncc_maps(print_spectra[k], moving, n, cv::sum(grid.mask)[0], config.min_overlap, k == 0 || polarity_known, ncc, score, overlap);
      found_per_pose[k][static_cast<std::size_t>(p)] =
          peaks(score, ncc, overlap, grid.value.size(), fixed, pitch, turned, all[static_cast<std::size_t>(p)].a * slab_centre);
    }

  PoseSearch out;
  for (int k = 0; k < 2; ++k) {
    std::vector<Found> found;
    for (std::size_t p = 0; p < all.size(); ++p)
      for (const Peak& peak : found_per_pose[k][p]) found.push_back({peak, p});
    (k == 0 ? out.gradient_peak_ratio : out.signed_peak_ratio) = pick(found, all, keep, k == 0, out.candidates);
  }
  return out;
}
}  // namespace venato::sync
