#pragma once
#include <array>
#include <vector>

#include "dem/fields/continuum_grid.h"
namespace venato::dem {

/// Shares of the cells of a grid in something smeared out by the kernel: a point, or a straight line of constant density. The shares of all cells
/// sum to 1 (less what falls off the grid); share / cell volume is the coarse-graining function, averaged over the cell.
class CellWeights {
 public:
  explicit CellWeights(const ContinuumGrid& grid) : grid_(grid) {}

  void point(const Vec3& at);
  /// Mean over s in [0, 1] of the share of the point from + s (to - from): the line integral of Goldhirsch's contact stress, exact to rounding.
  void line(const Vec3& from, const Vec3& to) { line(from, to, -1); }
  /// The same on faces: along `face_axis` the kernel density on the lower face of each cell [1/m] takes the place of the cell's share (what a
  /// balance over cells needs). `face_axis` must be resolved. Faces are numbered as the cells above them; a face beyond the last cell is left out.
  void line_on_faces(const Vec3& from, const Vec3& to, int face_axis) { line(from, to, face_axis); }

  /// f(cell, share, offset): offset = from the cell's centre to `origin` of the image that this share belongs to [m]; 0 along directions that are
  /// averaged over. Returns the sum of the shares that fell off the grid.
  template <class F>
  double for_each(const Vec3& origin, const F& f) const {
    double outside = 0;
    std::size_t at = 0;
    for (int k = 0; k < span_[2].count; ++k)
      for (int j = 0; j < span_[1].count; ++j)
        for (int i = 0; i < span_[0].count; ++i, ++at) {
          const double w = weight_[at];
          if (w == 0) continue;
          const int raw[3] = {span_[0].first + i, span_[1].first + j, span_[2].first + k};
          int cell[3];
          if (!inside(raw, cell)) {
            outside += w;
            continue;
          }
          Vec3 offset;
          for (int a = 0; a < 3; ++a) offset[a] = grid_.resolved(a) ? origin[a] - grid_.centre_m(a, raw[a]) : 0;
          f(grid_.index(cell[0], cell[1], cell[2]), w, offset);
        }
    return outside;
  }

 private:
  struct Span {
    int first = 0, count = 1;
  };
  void line(const Vec3& from, const Vec3& to, int face_axis);
  void set_spans(const Vec3& low, const Vec3& high);
  void add(const Vec3& at, double weight, int face_axis);
  bool inside(const int* raw, int* cell) const {
    for (int a = 0; a < 3; ++a) {
      const int n = grid_.n[static_cast<std::size_t>(a)];
      cell[a] = raw[a];
      if (grid_.periodic[static_cast<std::size_t>(a)])
        cell[a] = (raw[a] % n + n) % n;
      else if (raw[a] < 0 || raw[a] >= n)
        return false;
    }
    return true;
  }

  const ContinuumGrid& grid_;
  std::array<Span, 3> span_;
  std::array<std::vector<double>, 3> axis_;
  std::vector<double> weight_, breaks_;
};
}  // namespace venato::dem
