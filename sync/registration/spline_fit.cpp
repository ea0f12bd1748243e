#include "sync/registration/spline_fit.h"
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <utility>
#include "base/expects.h"
#include "sync/transform/bspline_basis.h"
namespace venato::sync {
namespace {
constexpr double kMm = 1e3;
// Ridge on every coefficient [1/mm^2]: keeps the matrix definite where no block speaks. Against data of weight ~1 it pulls a 10 mm displacement by 1
// um.
constexpr double kRidge = 1e-4;

struct Footprint {
  std::array<int, 16> place;  ///< NodeOrder
  std::array<double, 16> weight;
};
Footprint footprint(const BSplineField& grid, Point p) {
  const SplineCell x = spline_cell((p.x() - grid.origin_m.x()) / grid.spacing_m, grid.nx),
                   y = spline_cell((p.y() - grid.origin_m.y()) / grid.spacing_m, grid.ny);
  Footprint f;
  const NodeOrder order(grid);
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c) {
      f.place[4 * r + c] = order.at(x.first + static_cast<int>(c), y.first + static_cast<int>(r));
      f.weight[4 * r + c] = y.weight[r] * x.weight[c];
    }
  return f;
}

/// Adds the 2 x 2 block m to (k, l); only the lower triangle is kept, so both (k, l) and (l, k) must be added.
void add(BandMatrix& a, int k, int l, const Eigen::Matrix2d& m) {
  if (k < l) return;
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 2; ++c)
      if (2 * k + r >= 2 * l + c) a.at(2 * k + r, 2 * l + c) += m(r, c);
}
void add_difference(BandMatrix& m, std::initializer_list<std::pair<int, double>> terms, double weight) {
  for (const auto& [k, a] : terms)
    for (const auto& [l, b] : terms) add(m, k, l, weight * a * b * Eigen::Matrix2d::Identity());
}
void add_bending(BandMatrix& m, const NodeOrder& n, double lambda) {
  for (int j = 0; j < n.ny; ++j)
    for (int i = 0; i < n.nx; ++i) {
      const int k = n.at(i, j);
      if (i + 2 < n.nx) add_difference(m, {{k, 1.0}, {n.at(i + 1, j), -2.0}, {n.at(i + 2, j), 1.0}}, lambda);
      if (j + 2 < n.ny) add_difference(m, {{k, 1.0}, {n.at(i, j + 1), -2.0}, {n.at(i, j + 2), 1.0}}, lambda);
      if (i + 1 < n.nx && j + 1 < n.ny)
        add_difference(m, {{k, 1.0}, {n.at(i + 1, j), -1.0}, {n.at(i, j + 1), -1.0}, {n.at(i + 1, j + 1), 1.0}}, 2 * lambda);
      add(m, k, k, kRidge * Eigen::Matrix2d::Identity());
    }
}
Point residual(const Observation& o, const BSplineField& u) { return o.displacement_m - u.displacement(o.at_m); }
void add_evidence(BandMatrix& normal, std::span<const Footprint> footprints, std::span<const Observation> observations,
                  std::span<const double> weight) {
  for (std::size_t o = 0; o < observations.size(); ++o) {
    const Footprint& f = footprints[o];
    const Eigen::Matrix2d w = weight[o] * observations[o].information;
    for (std::size_t a = 0; a < 16; ++a)
      for (std::size_t b = 0; b < 16; ++b)
        if (f.place[b] <= f.place[a]) add(normal, f.place[a], f.place[b], f.weight[a] * f.weight[b] * w);
  }
}
void reweigh(std::span<const Observation> observations, const BSplineField& u, double robust_m, std::vector<double>& weight) {
  const double delta = robust_m * kMm;
  for (std::size_t o = 0; o < observations.size(); ++o) {
    const double half_trace = observations[o].information.trace() / 2;
    const double m2 = half_trace > 0 ? weighted_square(observations[o], u) / half_trace : 0;
    weight[o] = 1 / (1 + m2 / (delta * delta));
  }
}
}  // namespace

BandMatrix normal_matrix(std::span<const Observation> observations, std::span<const double> weight, const BSplineField& u, double lambda) {
  VENATO_EXPECTS(weight.size() == observations.size());
  const NodeOrder order(u);
  BandMatrix out(2 * u.nx * u.ny, order.half_band());
  add_bending(out, order, lambda);
  std::vector<Footprint> footprints;
  for (const Observation& o : observations) footprints.push_back(footprint(u, o.at_m));
  add_evidence(out, footprints, observations, weight);
  return out;
}

double bending_variance(const BSplineField& u, const BSplineField& reference) {
  VENATO_EXPECTS(u.nx == reference.nx && u.ny == reference.ny);
  double energy = 0;
  for (const auto& [of, from] : {std::pair(&u.cx, &reference.cx), std::pair(&u.cy, &reference.cy)}) {
    const auto at = [&, c = of, z = from](int i, int j) {
      const auto k = static_cast<std::size_t>(j) * static_cast<std::size_t>(u.nx) + static_cast<std::size_t>(i);
      return ((*c)[k] - (*z)[k]) * kMm;
    };
    for (int j = 0; j < u.ny; ++j)
      for (int i = 0; i < u.nx; ++i) {
        if (i + 2 < u.nx) energy += std::pow(at(i, j) - 2 * at(i + 1, j) + at(i + 2, j), 2);
        if (j + 2 < u.ny) energy += std::pow(at(i, j) - 2 * at(i, j + 1) + at(i, j + 2), 2);
        if (i + 1 < u.nx && j + 1 < u.ny) energy += 2 * std::pow(at(i, j) - at(i + 1, j) - at(i, j + 1) + at(i + 1, j + 1), 2);
      }
  }
  return energy / (2.0 * u.nx * u.ny);
}

double weighted_square(const Observation& o, const BSplineField& u) {
  const Point e = residual(o, u) * kMm;
  return e.dot(o.information * e);
}

double residual_across_m(const Observation& o, const BSplineField& u) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(o.information);
  return std::abs(eigen.eigenvectors().col(1).dot(residual(o, u)));
}

FitResult fit_spline(std::span<const Observation> observations, const BSplineField& reference, const FitSettings& settings,
                     const BSplineField* start) {
  VENATO_EXPECTS(reference.nx >= 4 && reference.ny >= 4 && settings.rounds >= 1);
  FitResult out;
  out.u = reference;
  out.weight.assign(observations.size(), 1.0);
  if (start) reweigh(observations, *start, settings.robust_m, out.weight);
  const NodeOrder order(reference);
  const int nodes = reference.nx * reference.ny;
  BandMatrix bending(2 * nodes, order.half_band());
  add_bending(bending, order, settings.lambda);
  std::vector<Footprint> footprints;
  std::vector<Point> wanted;  // displacement against the reference [mm]
  for (const Observation& o : observations) {
    footprints.push_back(footprint(reference, o.at_m));
    wanted.push_back((o.displacement_m - reference.displacement(o.at_m)) * kMm);
  }
  BandMatrix normal(1, 0);
  for (int round = 0; round < settings.rounds; ++round) {
    const bool last = round + 1 == settings.rounds;
    if (last)
      normal = std::move(bending);
    else
      normal = bending;
    add_evidence(normal, footprints, observations, out.weight);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * nodes);
    for (std::size_t o = 0; o < observations.size(); ++o) {
      const Footprint& f = footprints[o];
      const Eigen::Matrix2d w = out.weight[o] * observations[o].information;
      const Point wd = w * wanted[o];
      for (std::size_t a = 0; a < 16; ++a) right.segment<2>(2 * f.place[a]) += f.weight[a] * wd;
    }
    BandCholesky factor(std::move(normal));
    const Eigen::VectorXd change = factor.solve(std::move(right));
    normal = std::move(factor).release();
    for (int j = 0; j < reference.ny; ++j)
      for (int i = 0; i < reference.nx; ++i) {
        const auto k = static_cast<std::size_t>(j) * static_cast<std::size_t>(reference.nx) + static_cast<std::size_t>(i);
        out.u.cx[k] = reference.cx[k] + change(2 * order.at(i, j)) / kMm;
        out.u.cy[k] = reference.cy[k] + change(2 * order.at(i, j) + 1) / kMm;
      }
    if (!last) reweigh(observations, out.u, settings.robust_m, out.weight);  // the weights returned are those the result was fitted with
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
