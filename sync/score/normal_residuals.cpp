#include <algorithm>
#include <cmath>
#include <limits>
#include "base/expects.h"
#include "sync/score/centreline.h"
namespace venato::sync {
namespace {
/// Links sorted into square cells, for "which links come near this segment".
class LinkGrid {
 public:
  LinkGrid(const std::vector<CentreLink>& links, double cell_m) : cell_m_(cell_m) {
    Point lo(HUGE_VAL, HUGE_VAL), hi(-HUGE_VAL, -HUGE_VAL);
    for (const CentreLink& l : links) {
      lo = lo.cwiseMin(l.from_m.cwiseMin(l.to_m));
      hi = hi.cwiseMax(l.from_m.cwiseMax(l.to_m));
    }
    if (links.empty()) return;
    origin_ = lo;
    nx_ = 1 + static_cast<int>((hi.x() - lo.x()) / cell_m);
    ny_ = 1 + static_cast<int>((hi.y() - lo.y()) / cell_m);
    cells_.resize(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_));
    for (std::size_t k = 0; k < links.size(); ++k)
      visit(links[k].from_m, links[k].to_m, [&](std::vector<int>& cell) { cell.push_back(static_cast<int>(k)); });
  }
  /// Calls f(cell) for every cell that the bounding box of a-b touches.
  template <class F>
  void visit(Point a, Point b, F&& f) {
    if (cells_.empty()) return;
    const Point lo = (a.cwiseMin(b) - origin_) / cell_m_, hi = (a.cwiseMax(b) - origin_) / cell_m_;
    for (int j = std::max(0, static_cast<int>(std::floor(lo.y()))); j <= std::min(ny_ - 1, static_cast<int>(std::floor(hi.y()))); ++j)
      for (int i = std::max(0, static_cast<int>(std::floor(lo.x()))); i <= std::min(nx_ - 1, static_cast<int>(std::floor(hi.x()))); ++i)
        f(cells_[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i)]);
  }

 private:
  double cell_m_;
  Point origin_ = Point::Zero();
  int nx_ = 0, ny_ = 0;
  std::vector<std::vector<int>> cells_;
};
double cross(Point a, Point b) { return a.x() * b.y() - a.y() * b.x(); }
}  // namespace

std::vector<NormalResidual> normal_residuals(const std::vector<CentreLink>& lines, const std::vector<CentreLink>& partners,
                                             const ScoreConfig& config) {
  VENATO_EXPECTS(config.search_m > 0 && config.sample_step_m > 0);
  std::vector<NormalResidual> out;
  LinkGrid grid(partners, std::max(1e-3, config.search_m / 4));
  const double min_cosine = std::cos(config.direction_tolerance_rad);
  constexpr double kJoin = 1e-9;  // share of a link: neighbouring links meet without a gap
  for (const CentreLink& line : lines) {
    const Point along = line.to_m - line.from_m;
    const double norm = along.norm();
    if (!(norm > 0)) continue;
    const Point tangent = along / norm;
    Point normal(-tangent.y(), tangent.x());
    // One sign for the whole picture: positive = the partner lies towards +x (towards +y for lines along x).
    if (normal.x() < 0 || (normal.x() == 0 && normal.y() < 0)) normal = -normal;
    const int samples = std::max(1, static_cast<int>(std::lround(line.length_m / config.sample_step_m)));
    for (int k = 0; k < samples; ++k) {
      NormalResidual r;
      r.at_m = line.from_m + along * ((k + 0.5) / samples);
      r.length_m = line.length_m / samples;
      r.normal = normal, r.width_m = line.width_m;
      double best = std::numeric_limits<double>::infinity();
      grid.visit(r.at_m - config.search_m * normal, r.at_m + config.search_m * normal, [&](const std::vector<int>& cell) {
        for (const int index : cell) {
          const CentreLink& p = partners[static_cast<std::size_t>(index)];
          const Point step = p.to_m - p.from_m;
          const double length = step.norm();
          if (!(length > 0) || std::abs(step.dot(tangent)) < min_cosine * length) continue;
          const double denominator = cross(normal, step);
          if (std::abs(denominator) < 1e-15) continue;
          const Point gap = p.from_m - r.at_m;
          const double s = cross(gap, step) / denominator, t = cross(gap, normal) / denominator;
          if (t < -kJoin || t > 1 + kJoin || std::abs(s) > config.search_m || std::abs(s) >= std::abs(best)) continue;
          best = s;
        }
      });
      r.matched = std::isfinite(best);
      r.signed_distance_m = r.matched ? best : std::numeric_limits<double>::quiet_NaN();
      out.push_back(r);
    }
  }
  return out;
}
}  // namespace venato::sync
