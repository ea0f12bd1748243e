#include "sync/registration/spline_fit.h"
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include "base/error.h"
#include "base/expects.h"
#include "sync/transform/bspline_basis.h"
namespace venato::sync {
namespace {
constexpr double kMm = 1e3;
// Ridge on every coefficient [1/mm^2]: keeps the matrix definite where no block speaks. Against data of weight ~1 it pulls a 10 mm displacement by 1
// um.
constexpr double kRidge = 1e-4;

struct Footprint {
  std::array<int, 16> node;
  std::array<double, 16> weight;
};
Footprint footprint(const BSplineField& grid, Point p) {
  const SplineCell x = spline_cell((p.x() - grid.origin_m.x()) / grid.spacing_m, grid.nx),
                   y = spline_cell((p.y() - grid.origin_m.y()) / grid.spacing_m, grid.ny);
  Footprint f;
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c) {
      f.node[4 * r + c] = (y.first + static_cast<int>(r)) * grid.nx + x.first + static_cast<int>(c);
      f.weight[4 * r + c] = y.weight[r] * x.weight[c];
    }
  return f;
}

/// Symmetric 2 x 2-block matrix on the control grid whose blocks couple nodes at most 3 apart in x and y.
class StencilMatrix {
 public:
  explicit StencilMatrix(const BSplineField& grid)
      : nx_(grid.nx), nodes_(grid.nx * grid.ny), block_(static_cast<std::size_t>(nodes_) * kOffsets, Eigen::Matrix2d::Zero()) {}
  void add(int k, int l, const Eigen::Matrix2d& m) { block_[slot(k, l)] += m; }
  Eigen::SparseMatrix<double> lower() const {
    Eigen::SparseMatrix<double> out(2 * nodes_, 2 * nodes_);
    out.reserve(Eigen::VectorXi::Constant(2 * nodes_, 2 * 25));
    for (int k = 0; k < nodes_; ++k)
      for (int c = 0; c < 2; ++c) {
        const int i = k % nx_;
        for (int dj = 0; dj <= 3; ++dj)
          for (int di = -3; di <= 3; ++di) {
            if ((dj == 0 && di < 0) || i + di < 0 || i + di >= nx_) continue;
            const int l = k + dj * nx_ + di;
            if (l >= nodes_) continue;
            const Eigen::Matrix2d& m = block_[slot(l, k)];
            for (int r = (l == k ? c : 0); r < 2; ++r) out.insert(2 * l + r, 2 * k + c) = m(r, c);
          }
      }
    out.makeCompressed();
    return out;
  }

 private:
  static constexpr std::size_t kOffsets = 49;
  std::size_t slot(int k, int l) const {  // block (k, l)
    const int dj = l / nx_ - k / nx_, di = l % nx_ - k % nx_;
    return static_cast<std::size_t>(k) * kOffsets + static_cast<std::size_t>((dj + 3) * 7 + di + 3);
  }
  int nx_, nodes_;
  std::vector<Eigen::Matrix2d> block_;
};

void add_difference(StencilMatrix& m, std::initializer_list<std::pair<int, double>> terms, double weight) {
  for (const auto& [k, a] : terms)
    for (const auto& [l, b] : terms) m.add(k, l, weight * a * b * Eigen::Matrix2d::Identity());
}
void add_bending(StencilMatrix& m, int nx, int ny, double lambda) {
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int k = j * nx + i;
      if (i + 2 < nx) add_difference(m, {{k, 1.0}, {k + 1, -2.0}, {k + 2, 1.0}}, lambda);
      if (j + 2 < ny) add_difference(m, {{k, 1.0}, {k + nx, -2.0}, {k + 2 * nx, 1.0}}, lambda);
      if (i + 1 < nx && j + 1 < ny) add_difference(m, {{k, 1.0}, {k + 1, -1.0}, {k + nx, -1.0}, {k + nx + 1, 1.0}}, 2 * lambda);
      m.add(k, k, kRidge * Eigen::Matrix2d::Identity());
    }
}
Point residual(const Observation& o, const BSplineField& u) { return o.displacement_m - u.displacement(o.at_m); }
}  // namespace

double weighted_square(const Observation& o, const BSplineField& u) {
  const Point e = residual(o, u) * kMm;
  return e.dot(o.information * e);
}

double residual_across_m(const Observation& o, const BSplineField& u) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(o.information);
  return std::abs(eigen.eigenvectors().col(1).dot(residual(o, u)));
}

FitResult fit_spline(std::span<const Observation> observations, const BSplineField& reference, const FitSettings& settings) {
  VENATO_EXPECTS(reference.nx >= 4 && reference.ny >= 4 && settings.rounds >= 1);
  FitResult out;
  out.u = reference;
  out.weight.assign(observations.size(), 1.0);
  StencilMatrix bending(reference);
  add_bending(bending, reference.nx, reference.ny, settings.lambda);
  const int nodes = reference.nx * reference.ny;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver;
  for (int round = 0; round < settings.rounds; ++round) {
    StencilMatrix normal = bending;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * nodes);
    for (std::size_t o = 0; o < observations.size(); ++o) {
      const Footprint f = footprint(reference, observations[o].at_m);
      const Eigen::Matrix2d w = out.weight[o] * observations[o].information;
      const Point pull = w * (residual(observations[o], reference) * kMm);  // unknown: change against the reference
      for (std::size_t a = 0; a < 16; ++a) {
        right.segment<2>(2 * f.node[a]) += f.weight[a] * pull;
        for (std::size_t b = 0; b < 16; ++b) normal.add(f.node[a], f.node[b], f.weight[a] * f.weight[b] * w);
      }
    }
    out.normal_matrix = normal.lower();
    if (round == 0) solver.analyzePattern(out.normal_matrix);
    solver.factorize(out.normal_matrix);
    if (solver.info() != Eigen::Success) throw WorkError("registration: the spline's normal equations could not be factorised");
    const Eigen::VectorXd change = solver.solve(right);
    for (int k = 0; k < nodes; ++k) {
      out.u.cx[static_cast<std::size_t>(k)] = reference.cx[static_cast<std::size_t>(k)] + change(2 * k) / kMm;
      out.u.cy[static_cast<std::size_t>(k)] = reference.cy[static_cast<std::size_t>(k)] + change(2 * k + 1) / kMm;
    }
    if (round + 1 == settings.rounds) break;  // the weights returned are those the result was fitted with
    for (std::size_t o = 0; o < observations.size(); ++o) {
      const double half_trace = observations[o].information.trace() / 2;
      const double m2 = half_trace > 0 ? weighted_square(observations[o], out.u) / half_trace : 0;
      const double delta = settings.robust_m * kMm;
      out.weight[o] = 1 / (1 + m2 / (delta * delta));
    }
  }
  return out;
}

BSplineField project_field(const BSplineField& from, const BSplineField& grid) {
  BSplineField zero = grid;
  std::fill(zero.cx.begin(), zero.cx.end(), 0.0);
  std::fill(zero.cy.begin(), zero.cy.end(), 0.0);
  if (from.spacing_m <= 0) return zero;
  std::vector<Observation> samples;
  const double step = grid.spacing_m / 2;
  for (int j = 0; j <= 2 * (grid.ny - 3); ++j)
    for (int i = 0; i <= 2 * (grid.nx - 3); ++i) {
      const Point p = grid.origin_m + step * Point(i, j);
      samples.push_back({p, from.displacement(p), Eigen::Matrix2d::Identity()});
    }
  return fit_spline(samples, zero, {1e-4, 1.0, 1}).u;
}
}  // namespace venato::sync
