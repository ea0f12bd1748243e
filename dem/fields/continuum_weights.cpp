#include "dem/fields/continuum_weights.h"

#include <algorithm>
#include <cmath>

#include "base/expects.h"
#include "dem/fields/cg_kernel.h"

namespace venato::dem {

void CellWeights::set_spans(const Vec3& low, const Vec3& high) {
  const double reach = kKernelReach * grid_.width_m;
  std::size_t cells = 1;
  for (int a = 0; a < 3; ++a) {
    Span& s = span_[static_cast<std::size_t>(a)];
    s = Span{};
    if (grid_.resolved(a)) {
      s.first = static_cast<int>(std::floor((low[a] - reach - grid_.low[a]) / grid_.cell_m[a]));
      s.count = static_cast<int>(std::floor((high[a] + reach - grid_.low[a]) / grid_.cell_m[a])) - s.first + 1;
    }
    cells *= static_cast<std::size_t>(s.count);
  }
  weight_.assign(cells, 0);
}

void CellWeights::add(const Vec3& at, double weight, int face_axis) {
  const double reach = kKernelReach * grid_.width_m;
  for (int a = 0; a < 3; ++a) {
    const Span& s = span_[static_cast<std::size_t>(a)];
    std::vector<double>& w = axis_[static_cast<std::size_t>(a)];
    w.assign(static_cast<std::size_t>(s.count), 1);
    if (!grid_.resolved(a)) continue;
    const auto face = [&](int k) { return (grid_.low[a] + (s.first + k) * grid_.cell_m[a] - at[a]) / reach; };
    if (a == face_axis) {
      for (int k = 0; k < s.count; ++k) w[static_cast<std::size_t>(k)] = kernel_density(face(k)) / reach;
      continue;
    }
    double below = kernel_integral(face(0));
    for (int k = 0; k < s.count; ++k) {
      const double above = kernel_integral(face(k + 1));
      w[static_cast<std::size_t>(k)] = above - below;
      below = above;
    }
  }
  double* out = weight_.data();
  for (const double wz : axis_[2])
    for (const double wy : axis_[1]) {
      const double yz = weight * wz * wy;
      for (const double wx : axis_[0]) *out++ += yz * wx;
    }
}

void CellWeights::point(const Vec3& at) {
  set_spans(at, at);
  add(at, 1, -1);
}

void CellWeights::line(const Vec3& from, const Vec3& to, int face_axis) {
  VENATO_EXPECTS(face_axis < 0 || grid_.resolved(face_axis));
  set_spans(from.cwiseMin(to), from.cwiseMax(to));
  const double reach = kKernelReach * grid_.width_m;
  const Vec3 along = to - from;
  breaks_.assign({0, 1});
  for (int a = 0; a < 3; ++a) {
    if (!grid_.resolved(a) || along[a] == 0) continue;
    for (const double edge : {-reach, reach}) {  // a face meets the edge of the kernel of the moving point: another polynomial from there on
      const double g0 = (from[a] + edge - grid_.low[a]) / grid_.cell_m[a], g1 = (to[a] + edge - grid_.low[a]) / grid_.cell_m[a];
      for (double g = std::ceil(std::min(g0, g1)); g <= std::max(g0, g1); g += 1) {
        const double s = (g - g0) / (g1 - g0);
        if (s > 0 && s < 1) breaks_.push_back(s);
      }
    }
  }
  std::sort(breaks_.begin(), breaks_.end());
  for (std::size_t b = 0; b + 1 < breaks_.size(); ++b) {
    const double s0 = breaks_[b], length = breaks_[b + 1] - s0;
    if (!(length > 0)) continue;
    // The product of three kernels has degree 21; over a piece of half a width six points leave nothing above rounding.
    const int pieces = std::max(1, static_cast<int>(std::ceil(2 * length * along.norm() / grid_.width_m)));
    for (int p = 0; p < pieces; ++p)
      for (const GaussPoint& g : kGauss) add(from + (s0 + length * (p + g.at) / pieces) * along, g.weight * length / pieces, face_axis);
  }
}
}  // namespace venato::dem
