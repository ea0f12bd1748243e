#include "sync/registration/posterior.h"
#include <algorithm>
#include <cmath>
#include "sync/registration/spline_fit.h"
#include "sync/transform/bspline_basis.h"
namespace venato::sync {
namespace {
constexpr double kMm = 1e3;
}

graphics::RasterF sigma_map(const BSplineField& u, const BandMatrix& normal, double unit_variance, double width_m, double height_m, double pitch_m,
                            int threads) {
  const BandInverse inverse{BandCholesky(normal)};
  const NodeOrder order(u);
  const int w = std::max(1, static_cast<int>(std::ceil(width_m / pitch_m - 1e-9))),
            h = std::max(1, static_cast<int>(std::ceil(height_m / pitch_m - 1e-9)));
  graphics::RasterF out(w, h, 1, pitch_m);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      const SplineCell x = spline_cell(((i + 0.5) * pitch_m - u.origin_m.x()) / u.spacing_m, u.nx),
                       y = spline_cell(((j + 0.5) * pitch_m - u.origin_m.y()) / u.spacing_m, u.ny);
      int node[16];
      double weight[16], variance = 0;
      for (int k = 0; k < 16; ++k) {
        node[k] = order.at(x.first + k % 4, y.first + k / 4);
        weight[k] = y.weight[static_cast<std::size_t>(k / 4)] * x.weight[static_cast<std::size_t>(k % 4)];
      }
      for (int k = 0; k < 16; ++k)
        for (int l = 0; l <= k; ++l)
          variance +=
              (k == l ? 1 : 2) * weight[k] * weight[l] * (inverse.at(2 * node[k], 2 * node[l]) + inverse.at(2 * node[k] + 1, 2 * node[l] + 1));
      out.at(i, j) = static_cast<float>(std::sqrt(std::max(0.0, variance * unit_variance)) / kMm);
    }
  return out;
}
}  // namespace venato::sync
