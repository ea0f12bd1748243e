#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "graphics/rectify/camera.h"
#include "graphics/rectify/homography.h"
namespace venato::graphics {
namespace {
constexpr double kSameMark_px = 2, kSameMark_m = 0.001;  // marks nearer than that are one mark
constexpr double kOnLine = 0.01;       // height over longest side of a triangle of marks: below it a mark found 1 px wrong moves the slab by its size
constexpr double kHorizonShare = 0.1;  // nearest over farthest depth on the slab: a camera that flat resolves nothing at the far end
constexpr int kScaleSamples = 16;

std::string text(const char* format, double a, double b = 0, double c = 0, double d = 0) {
  char buffer[240];
  std::snprintf(buffer, sizeof buffer, format, a, b, c, d);
  return buffer;
}
[[noreturn]] void refuse(const CameraView& view, const std::string& reason) { throw UsageError(view.file.string() + ": " + reason); }
std::string mark_name(std::size_t k) { return "/marks/" + std::to_string(k); }

double flatness(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - a;
  const double longest = std::max({u.norm(), v.norm(), (c - b).norm()});
  return std::abs(u.x() * v.y() - u.y() * v.x()) / (longest * longest);
}

void check_marks(const CameraView& view, int width_px, int height_px) {
  const auto& m = view.marks;
  for (std::size_t k = 0; k < m.size(); ++k) {
    const Eigen::Vector2d& p = m[k].picture_px;
    if (!(p.x() >= -0.5 && p.y() >= -0.5 && p.x() <= width_px - 0.5 && p.y() <= height_px - 0.5))
      refuse(view, mark_name(k) + "/px: (" + text("%.6g, %.6g) is outside the picture of %.0f x %.0f px", p.x(), p.y(), width_px, height_px));
    for (std::size_t i = 0; i < k; ++i)
      if ((m[i].picture_px - p).norm() < kSameMark_px || (m[i].slab_m - m[k].slab_m).norm() < kSameMark_m)
        refuse(view, mark_name(k) + ": is the same place as " + mark_name(i) + " (within 2 px or 1 mm)");
  }
  if (m.size() != 4) return;
  for (std::size_t left_out = 0; left_out < 4; ++left_out) {
    const std::size_t a = (left_out + 1) % 4, b = (left_out + 2) % 4, c = (left_out + 3) % 4;
    if (flatness(m[a].picture_px, m[b].picture_px, m[c].picture_px) < kOnLine || flatness(m[a].slab_m, m[b].slab_m, m[c].slab_m) < kOnLine)
      refuse(view, "the marks " + std::to_string(a) + ", " + std::to_string(b) + " and " + std::to_string(c) +
                       " lie on one line; four marks must be corners of a quadrilateral, e.g. near the slab's corners");
  }
}

std::vector<Eigen::Vector2d> slab_grid(const CameraView& view) {
  std::vector<Eigen::Vector2d> out;
  for (int j = 0; j <= kScaleSamples; ++j)
    for (int i = 0; i <= kScaleSamples; ++i) out.emplace_back(view.width_m * i / kScaleSamples, view.height_m * j / kScaleSamples);
  return out;
}

void fit_marks(const CameraView& view, SolvedView& out) {
  std::vector<Eigen::Vector2d> ideal, slab;
  for (std::size_t k = 0; k < view.marks.size(); ++k) {
    Eigen::Vector2d p = view.marks[k].picture_px;
    if (view.lens && !undistorted(*view.lens, view.marks[k].picture_px, p))
      refuse(view, mark_name(k) + "/px: the lens cannot have imaged anything there (its distortion folds back); check k1, k2, k3, fx_px and fy_px");
    ideal.push_back(p);
    slab.push_back(view.marks[k].slab_m);
  }
  const auto h = fit_homography(slab, ideal);
  if (!h) refuse(view, "/marks: do not say where the slab is: all but one of them lie on one line, or several in one place");
  out.ideal_px_from_slab_m = *h;
  out.marks = static_cast<int>(view.marks.size());
}

/// On the slab, after its place in the picture is known to be sound.
void measure_marks(const CameraView& view, SolvedView& out) {
  if (view.marks.size() < 5) return;
  const Eigen::Matrix3d back = out.ideal_px_from_slab_m.inverse();
  std::vector<double> miss;
  for (const Mark& mark : view.marks) {
    Eigen::Vector2d p = mark.picture_px;
    if (view.lens) undistorted(*view.lens, mark.picture_px, p);
    miss.push_back((project(back, p) - mark.slab_m).norm());
  }
  const auto worst = static_cast<std::size_t>(std::max_element(miss.begin(), miss.end()) - miss.begin());
  out.mark_max_m = miss[worst];
  std::nth_element(miss.begin(), miss.begin() + static_cast<std::ptrdiff_t>(miss.size() / 2), miss.end());
  out.mark_median_m = miss[miss.size() / 2];
  if (!(out.mark_max_m <= view.mark_limit_m))
    refuse(view, mark_name(worst) + ": is " +
                     text("%.3g mm off the fit of all %.0f marks (mark_limit_mm %.3g; median %.3g mm)", out.mark_max_m * 1e3, out.marks,
                          view.mark_limit_m * 1e3, out.mark_median_m * 1e3) +
                     ": a wrong mark, or the lens needs its distortion");
}

void check_sight(const CameraView& view, SolvedView& out) {
  const char* what = view.marks.empty() ? "/mm_from_px" : "/marks";
  const Eigen::Matrix3d& h = out.ideal_px_from_slab_m;
  if (!h.allFinite()) refuse(view, std::string(what) + ": the homography has no inverse");
  double nearest = HUGE_VAL, farthest = -HUGE_VAL;
  for (const double x : {0.0, view.width_m})
    for (const double y : {0.0, view.height_m}) {
      const double depth = (h * Eigen::Vector3d(x, y, 1)).z();
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  if (nearest < 0 && farthest < 0) std::swap(nearest *= -1, farthest *= -1);  // a homography's sign is free
  if (!(nearest > kHorizonShare * farthest))
    refuse(view, std::string(what) +
                     (nearest > 0 ? ": the slab's far end would be ten times as far from the camera as its near end"
                                  : ": the horizon of the picture would cross the slab") +
                     "; are marks in the wrong order?");
  double finest = HUGE_VAL, coarsest = 0;
  for (const Eigen::Vector2d& p : slab_grid(view)) {
    const Eigen::Matrix2d slope = project_slope(h, p);
    if (!(slope.determinant() > 0))
      refuse(view, std::string(what) +
                       ": the picture would be a mirror image of the slab; are two marks swapped? (A picture taken in a mirror has to be "
                       "flipped first.)");
    const Eigen::Vector2d stretch = Eigen::JacobiSVD<Eigen::Matrix2d>(slope).singularValues();
    finest = std::min(finest, 1 / stretch[0]);
    coarsest = std::max(coarsest, 1 / stretch[1]);
  }
  out.finest_m_px = finest;
  out.coarsest_m_px = coarsest;
}
}  // namespace

bool SolvedView::locate(const Eigen::Vector2d& slab_m, Eigen::Vector2d& picture_px) const {
  picture_px = project(ideal_px_from_slab_m, slab_m);
  if (!lens) return true;
  if (!(radius(*lens, picture_px) <= radius_limit)) return false;
  picture_px = distorted(*lens, picture_px);
  return true;
}

SolvedView solve_view(const CameraView& view, int width_px, int height_px) {
  SolvedView out;
  out.lens = view.lens;
  if (view.marks.empty()) {
    const Eigen::FullPivLU<Eigen::Matrix3d> lu(view.slab_m_from_ideal_px);
    if (!lu.isInvertible()) refuse(view, "/mm_from_px: the homography has no inverse");
    out.ideal_px_from_slab_m = lu.inverse();
  } else {
    check_marks(view, width_px, height_px);
    fit_marks(view, out);
  }
  check_sight(view, out);
  measure_marks(view, out);
  if (view.lens) {
    double farthest = 0;
    for (const Eigen::Vector2d& p : slab_grid(view)) farthest = std::max(farthest, radius(*view.lens, project(out.ideal_px_from_slab_m, p)));
    out.radius_limit = radius_limit(*view.lens, farthest * (1 + 1e-9));
  }
  return out;
}
}  // namespace venato::graphics
