#include <cmath>
#include <vector>
#include "base/expects.h"
#include "sync/transform/bspline_basis.h"
#include "sync/transform/transform.h"
namespace venato::sync {

Point BSplineField::displacement(Point p) const {
  if (spacing_m <= 0) return Point::Zero();
  const SplineCell x = spline_cell((p.x() - origin_m.x()) / spacing_m, nx), y = spline_cell((p.y() - origin_m.y()) / spacing_m, ny);
  Point sum = Point::Zero();
  for (int r = 0; r < 4; ++r) {
    const std::size_t row = static_cast<std::size_t>(y.first + r) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x.first);
    double sx = 0, sy = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      sx += x.weight[c] * cx[row + c];
      sy += x.weight[c] * cy[row + c];
    }
    sum += y.weight[static_cast<std::size_t>(r)] * Point(sx, sy);
  }
  return sum;
}

Eigen::Matrix2d BSplineField::gradient(Point p) const {
  Eigen::Matrix2d g = Eigen::Matrix2d::Zero();
  if (spacing_m <= 0) return g;
  const SplineCell x = spline_cell((p.x() - origin_m.x()) / spacing_m, nx), y = spline_cell((p.y() - origin_m.y()) / spacing_m, ny);
  for (std::size_t r = 0; r < 4; ++r) {
    const std::size_t row = (static_cast<std::size_t>(y.first) + r) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x.first);
    for (std::size_t c = 0; c < 4; ++c) {
      const Point coefficient(cx[row + c], cy[row + c]);
      g.col(0) += coefficient * (x.derivative[c] * y.weight[r]);
      g.col(1) += coefficient * (x.weight[c] * y.derivative[r]);
    }
  }
  return g / spacing_m;
}

BSplineField make_zero_field(double width_m, double height_m, double spacing_m) {
  VENATO_EXPECTS(width_m > 0 && height_m > 0 && spacing_m > 0);
  BSplineField u;
  u.spacing_m = spacing_m;
  // The small epsilon keeps a slab of exactly k spacings from growing a useless extra column through rounding.
  u.nx = 3 + std::max(1, static_cast<int>(std::ceil(width_m / spacing_m - 1e-9)));
  u.ny = 3 + std::max(1, static_cast<int>(std::ceil(height_m / spacing_m - 1e-9)));
  u.cx.assign(static_cast<std::size_t>(u.nx) * static_cast<std::size_t>(u.ny), 0.0);
  u.cy = u.cx;
  return u;
}

RowDisplacement::RowDisplacement(const BSplineField& u, double x0_m, double dx_m, int n) : u_(u) {
  if (u.spacing_m <= 0) return;
  cells_.reserve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    const SplineCell c = spline_cell((x0_m + k * dx_m - u.origin_m.x()) / u.spacing_m, u.nx);
    cells_.push_back({c.first, c.weight});
  }
}

void RowDisplacement::at(double y_m, int n, double* ux, double* uy) const {
  if (u_.spacing_m <= 0) {
    std::fill_n(ux, n, 0.0);
    std::fill_n(uy, n, 0.0);
    return;
  }
  VENATO_EXPECTS(n <= static_cast<int>(cells_.size()));
  const SplineCell y = spline_cell((y_m - u_.origin_m.y()) / u_.spacing_m, u_.ny);
  const auto columns = static_cast<std::size_t>(u_.nx);
  std::vector<double> row_x(columns, 0.0), row_y(columns, 0.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const double* sx = u_.cx.data() + (static_cast<std::size_t>(y.first) + r) * columns;
    const double* sy = u_.cy.data() + (static_cast<std::size_t>(y.first) + r) * columns;
    for (std::size_t c = 0; c < columns; ++c) {
      row_x[c] += y.weight[r] * sx[c];
      row_y[c] += y.weight[r] * sy[c];
    }
  }
  for (int k = 0; k < n; ++k) {
    const Cell& x = cells_[static_cast<std::size_t>(k)];
    const double *sx = row_x.data() + x.first, *sy = row_y.data() + x.first;
    ux[k] = x.weight[0] * sx[0] + x.weight[1] * sx[1] + x.weight[2] * sx[2] + x.weight[3] * sx[3];
    uy[k] = x.weight[0] * sy[0] + x.weight[1] * sy[1] + x.weight[2] * sy[2] + x.weight[3] * sy[3];
  }
}

void displacement_row(const BSplineField& u, double y_m, double x0_m, double dx_m, int n, double* ux, double* uy) {
  RowDisplacement(u, x0_m, dx_m, n).at(y_m, n, ux, uy);
}

JacobianRange jacobian_range(const BSplineField& u, double width_m, double height_m, double step_m) {
  VENATO_EXPECTS(width_m > 0 && height_m > 0 && step_m > 0);
  if (u.spacing_m <= 0) return {1, 1};
  const int nx = 2 + static_cast<int>(width_m / step_m), ny = 2 + static_cast<int>(height_m / step_m);
  std::vector<double> ux(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny)), uy(ux.size());
  const auto at = [nx](int i, int j) { return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i); };
  for (int j = 0; j < ny; ++j) displacement_row(u, j * step_m, 0, step_m, nx, &ux[at(0, j)], &uy[at(0, j)]);
  JacobianRange range{HUGE_VAL, -HUGE_VAL};
  // Each grid cell has four corners; at a corner its two cell edges give one forward/backward pair, so a pass over cells visits all four
  // combinations of every interior point.
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i)
      for (int ey = 0; ey < 2; ++ey)
        for (int ex = 0; ex < 2; ++ex) {
          const std::size_t left = at(i, j + ey), right = at(i + 1, j + ey), up = at(i + ex, j), down = at(i + ex, j + 1);
          const double xx = 1 + (ux[right] - ux[left]) / step_m, yx = (uy[right] - uy[left]) / step_m;
          const double xy = (ux[down] - ux[up]) / step_m, yy = 1 + (uy[down] - uy[up]) / step_m;
          const double determinant = xx * yy - xy * yx;
          range.min = std::min(range.min, determinant);
          range.max = std::max(range.max, determinant);
        }
  return range;
}
}  // namespace venato::sync
