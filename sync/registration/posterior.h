#pragma once
#include "graphics/raster/raster.h"
#include "sync/registration/band_matrix.h"
#include "sync/transform/transform.h"
namespace venato::sync {

/// Root mean square error of the displacement, |error| over both components, on a grid of `pitch_m` over the slab:
/// sqrt(unit_variance * trace(B A^-1 B^T)) with the fit's normal matrix A [1/mm^2].
/// \param unit_variance  [-] variance of a residual of unit weight, i.e. mean of (e^T W e) / 2
/// \throws WorkError if the matrix cannot be factorised
graphics::RasterF sigma_map(const BSplineField& u, const BandMatrix& normal, double unit_variance, double width_m, double height_m, double pitch_m,
                            int threads);
}  // namespace venato::sync
