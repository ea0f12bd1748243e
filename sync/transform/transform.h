#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>
namespace venato::sync {
using Point = Eigen::Vector2d;  ///< metres; x across, y along, origin top-left corner of the frame

/// Smooth displacement field: uniform cubic B-spline coefficients over a rectangle starting at `origin_m`.
/// Coefficient (i, j) is centred on origin_m + spacing_m * (i - 1, j - 1); the rectangle is [0, (nx - 3)] x [0, (ny - 3)] spacings from origin_m.
/// Outside of it the position is clamped to the rectangle first (constant continuation), so that no evaluation can explode.
struct BSplineField {
  Point origin_m = Point::Zero();
  double spacing_m = 0;        ///< 0 = no displacement
  int nx = 0, ny = 0;          ///< control points
  std::vector<double> cx, cy;  ///< [ny][nx] metres
  Point displacement(Point p) const;
  Eigen::Matrix2d gradient(Point p) const;  ///< d displacement / d position; 0 across an edge that the position was clamped to
};
/// Field of zeros whose rectangle covers [0, width_m] x [0, height_m] with the given control point spacing. \pre all > 0
BSplineField make_zero_field(double width_m, double height_m, double spacing_m);
/// displacement() of the points (x0_m + k dx_m, y), k < n, for many rows y: what depends on x is worked out once. Keeps a reference to the field.
class RowDisplacement {
 public:
  RowDisplacement(const BSplineField& u, double x0_m, double dx_m, int n);
  /// \param ux, uy [m] n values each are written. \pre n as constructed or less
  void at(double y_m, int n, double* ux, double* uy) const;

 private:
  struct Cell {
    int first;
    std::array<double, 4> weight;
  };
  const BSplineField& u_;
  std::vector<Cell> cells_;
};
/// displacement() of n points (x0_m + k dx_m, y_m): the same values, several times faster (one row of 1-D splines).
/// \param ux, uy [m] n values each are written
void displacement_row(const BSplineField& u, double y_m, double x0_m, double dx_m, int n, double* ux, double* uy);

/// print_from_green(p) = A (p + u(p)) + t : where in the print (graphic) frame the ink lies that belongs on slab point p.
struct Transform {
  Eigen::Matrix2d a = Eigen::Matrix2d::Identity();
  Point t = Point::Zero();
  BSplineField u;
  Point operator()(Point green_m) const;
  Eigen::Matrix2d jacobian(Point green_m) const;
  /// Damped Newton inverse, residual below 1e-9 m in the green frame. \throws WorkError where the map folds or A is singular.
  Point inverse(Point print_m) const;
};

/// The affine part in words: print_from_green turns by turn_deg (0, 90, 180, 270: x towards y) and by rotation_rad (-45 to 45 deg) more, after
/// mirroring x if `mirrored`; corner_m is where the green frame's origin lies in the print frame. Stretch is left out.
struct Lying {
  bool mirrored = false;
  int turn_deg = 0;
  double rotation_rad = 0;
  Point corner_m = Point::Zero();
};
Lying how_it_lies(const Transform& affine);

/// How the slab is stretched against the graphic, in the slab's own axes: x across the belt, y along it. The affine part is rotation (and mirror)
/// times a symmetric stretch (polar decomposition); this is the inverse of that stretch less one, so that positive = the slab is longer than the
/// graphic.
struct SlabStretch {
  double along = 0, across = 0;  ///< [-] relative; belts of different speeds show in `along` alone, a wrong mm per pixel in both
  double shear = 0;              ///< [-] departure of the angle between x and y from 90 deg [rad], > 0 if it is smaller
};
/// \throws WorkError when the affine part is singular
SlabStretch slab_stretch(const Transform& affine);
/// Least-squares affine part of the whole map on a grid of `step_m` over [0, width_m] x [0, height_m].
/// \pre width_m, height_m >= step_m
Transform mean_affine(const Transform& map, double width_m, double height_m, double step_m);

/// Smallest and largest Jacobian determinant of p -> p + u(p) on a grid of `step_m` over [0, width_m] x [0, height_m].
/// All four combinations of forward and backward differences are taken: the central difference misses chequerboard folds.
/// The map does not fold on the grid if min > 0. Source: Liu et al., IJCV 2024 (arXiv 2212.06060).
struct JacobianRange {
  double min = 1, max = 1;
};
JacobianRange jacobian_range(const BSplineField& u, double width_m, double height_m, double step_m);
}  // namespace venato::sync
