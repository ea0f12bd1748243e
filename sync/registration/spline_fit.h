#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <vector>
#include "sync/registration/band_matrix.h"
#include "sync/transform/transform.h"
namespace venato::sync {

/// One measured displacement and how well each direction of it is known.
struct Observation {
  Point at_m;  ///< green frame
  Point displacement_m;
  Eigen::Matrix2d information;  ///< [1/mm^2] symmetric, >= 0; a straight vein has rank 1: the aperture problem is represented, not hidden
};
struct FitSettings {
  double lambda = 0.03;      ///< weight of the bending of the coefficients [mm^2]
  double robust_m = 0.0015;  ///< residuals beyond this lose weight: 1 / (1 + (m / robust)^2)
  int rounds = 4;
};
struct FitResult {
  BSplineField u;
  std::vector<double> weight;  ///< robust weight per observation, 0..1
};
/// Numbering of the control points along the shorter side first, which makes the band of the normal matrix narrow.
struct NodeOrder {
  int nx, ny;
  explicit NodeOrder(const BSplineField& u) : nx(u.nx), ny(u.ny) {}
  int at(int i, int j) const { return nx <= ny ? j * nx + i : i * ny + j; }
  int half_band() const { return 2 * (3 * std::min(nx, ny) + 3) + 1; }  ///< control points that meet in one cell are at most 3 apart each way
};
/// min sum rho((d - u)^T W (d - u)) + lambda bending(u - reference) over the coefficients of a uniform cubic B-spline. Bending = squared second
/// differences of the coefficients in x and in y + 2 x squared mixed first differences, per component. Normal equations in a band.
/// \param reference  field on the wanted grid; the fit is pulled towards its shape (zeros: towards an affine map)
/// \param start  field whose residuals give the first round's robust weights; without one all weights start at 1
/// \throws WorkError when the normal matrix cannot be factorised (cannot happen for finite input: a weak ridge keeps it definite)
FitResult fit_spline(std::span<const Observation> observations, const BSplineField& reference, const FitSettings& settings,
                     const BSplineField* start = nullptr);

/// Normal matrix of the fit [1/mm^2] on u's grid, with other weights of observations and bending than a fit used.
BandMatrix normal_matrix(std::span<const Observation> observations, std::span<const double> weight, const BSplineField& u, double lambda);
/// Variance of one bending term of u - reference [mm^2] if its coefficients were drawn with independent bending terms: bending / unknowns.
double bending_variance(const BSplineField& u, const BSplineField& reference);
/// Squared residual (d - u)^T W (d - u) [-].
double weighted_square(const Observation& o, const BSplineField& u);
/// |residual| along the better known direction of W [m]: the misfit across the vein.
double residual_across_m(const Observation& o, const BSplineField& u);
/// Least-squares copy of a displacement field on another grid, for the next level or a prior.
BSplineField project_field(const BSplineField& from, const BSplineField& grid);
}  // namespace venato::sync
