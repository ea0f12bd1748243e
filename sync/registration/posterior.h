#pragma once
#include <Eigen/SparseCore>
#include "graphics/raster/raster.h"
#include "sync/transform/transform.h"
namespace venato::sync {

/// Entries of the inverse of a symmetric positive definite sparse matrix at the positions of its Cholesky factor (Takahashi's recursion), which
/// hold every pair of unknowns that meet in one observation. Source: Takahashi, Fagan & Chen 1973; Erisman & Tinney, Comm. ACM 18 (1975) 177.
class SelectedInverse {
 public:
  /// \param lower  lower triangle of the matrix. \throws WorkError if it cannot be factorised
  explicit SelectedInverse(const Eigen::SparseMatrix<double>& lower);
  /// (A^-1)(i, j). \pre (i, j) lies in the factor's pattern, e.g. A(i, j) is stored
  double at(int i, int j) const;

 private:
  Eigen::SparseMatrix<double> z_;  ///< lower, permuted
  Eigen::VectorXi where_;          ///< permuted index of an unknown
};

/// Root mean square error of the displacement, |error| over both components, on a grid of `pitch_m` over the slab:
/// sqrt(unit_variance * trace(B A^-1 B^T)) with the fit's normal matrix A [1/mm^2].
/// \param unit_variance  [-] variance of a residual of unit weight, i.e. mean of (e^T W e) / 2
graphics::RasterF sigma_map(const BSplineField& u, const Eigen::SparseMatrix<double>& normal_lower, double unit_variance, double width_m,
                            double height_m, double pitch_m, int threads);
}  // namespace venato::sync
