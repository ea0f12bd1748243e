#include "sync/transform/transform.h"
#include <gtest/gtest.h>
#include <Eigen/LU>
#include <cmath>
#include "base/error.h"
namespace venato::sync {
namespace {

BSplineField wavy_field(double amplitude_m) {
  BSplineField u = make_zero_field(0.6, 1.2, 0.1);
  for (int j = 0; j < u.ny; ++j)
    for (int i = 0; i < u.nx; ++i) {
      const auto k = static_cast<std::size_t>(j * u.nx + i);
      u.cx[k] = amplitude_m * std::sin(0.9 * i + 0.4 * j);
      u.cy[k] = amplitude_m * std::cos(0.5 * i - 0.7 * j);
    }
  return u;
}

TEST(BSplineField, ReproducesConstantsAndLinesExactly) {
  // Cubic B-splines reproduce polynomials up to degree 1 from coefficients that sample them at the control points.
  BSplineField u = make_zero_field(0.6, 1.2, 0.1);
  for (int j = 0; j < u.ny; ++j)
    for (int i = 0; i < u.nx; ++i) {
      const auto k = static_cast<std::size_t>(j * u.nx + i);
      u.cx[k] = 0.003;
      u.cy[k] = 0.02 * (i - 1) * u.spacing_m - 0.01 * (j - 1) * u.spacing_m;
    }
  for (const Point& p : {Point(0, 0), Point(0.123, 0.777), Point(0.6, 1.2), Point(0.05, 1.19)}) {
    EXPECT_NEAR(u.displacement(p).x(), 0.003, 1e-15);
    EXPECT_NEAR(u.displacement(p).y(), 0.02 * p.x() - 0.01 * p.y(), 1e-15);
    EXPECT_NEAR(u.gradient(p)(1, 0), 0.02, 1e-14);
    EXPECT_NEAR(u.gradient(p)(1, 1), -0.01, 1e-14);
    EXPECT_NEAR(u.gradient(p)(0, 0), 0, 1e-14);
  }
}

TEST(BSplineField, CubicPatchAgreesWithTheTextbookBump) {
  // One unit coefficient gives the cubic B-spline: 4/6 at its centre, 1/6 one spacing away, 0 two away.
  BSplineField u = make_zero_field(1.0, 1.0, 0.1);
  u.cx[static_cast<std::size_t>(5 * u.nx + 6)] = 1;  // centred on ((6 - 1), (5 - 1)) * 0.1
  EXPECT_NEAR(u.displacement({0.5, 0.4}).x(), 16.0 / 36, 1e-14);
  EXPECT_NEAR(u.displacement({0.6, 0.4}).x(), 4.0 / 36, 1e-14);
  EXPECT_NEAR(u.displacement({0.6, 0.3}).x(), 1.0 / 36, 1e-14);
  EXPECT_NEAR(u.displacement({0.7, 0.4}).x(), 0, 1e-14);
  EXPECT_NEAR(u.displacement({0.55, 0.4}).x(), 23.0 / 48 * 4.0 / 6, 1e-14);
}

TEST(BSplineField, GradientIsTheDerivativeAndOutsideIsClamped) {
  const BSplineField u = wavy_field(0.004);
  const double h = 1e-6;  // central difference error ~ h^2 u''' ~ 1e-12 / 1e-3 m scale, rounding ~1e-16/h = 1e-10
  for (const Point& p : {Point(0.11, 0.52), Point(0.33, 1.01), Point(0.591, 0.013)}) {
    const Eigen::Matrix2d g = u.gradient(p);
    for (int axis = 0; axis < 2; ++axis) {
      const Point e = Point::Unit(axis) * h;
      const Point d = (u.displacement(p + e) - u.displacement(p - e)) / (2 * h);
      EXPECT_NEAR(g(0, axis), d.x(), 1e-8);
      EXPECT_NEAR(g(1, axis), d.y(), 1e-8);
    }
  }
  EXPECT_EQ(u.displacement({-0.5, 0.3}), u.displacement({0, 0.3}));
  EXPECT_NEAR((u.displacement({0.2, 99}) - u.displacement({0.2, 1.2})).norm(), 0, 1e-15);  // 1.2 / 0.1 rounds to just inside the last cell
  EXPECT_EQ(BSplineField{}.displacement({0.1, 0.2}), Point(0, 0));
}

TEST(BSplineField, RowEvaluationEqualsPointEvaluation) {
  const BSplineField u = wavy_field(0.004);
  double ux[50], uy[50];
  displacement_row(u, 0.4321, -0.02, 0.013, 50, ux, uy);
  for (int k = 0; k < 50; ++k) {
    const Point d = u.displacement({-0.02 + k * 0.013, 0.4321});
    EXPECT_NEAR(ux[k], d.x(), 1e-16);  // other order of summation: last bits only
    EXPECT_NEAR(uy[k], d.y(), 1e-16);
  }
}

TEST(Transform, InverseRoundTripToANanometre) {
  Transform m;
  m.a << 0.0174, -1.004, 0.998, 0.02;  // a quarter turn with some scale and shear
  m.t = {0.7, -0.03};
  m.u = wavy_field(0.010);
  for (double x = 0; x <= 0.6; x += 0.06)
    for (double y = 0; y <= 1.2; y += 0.06) {
      const Point p(x, y);
      EXPECT_NEAR((m.inverse(m(p)) - p).norm(), 0, 1.1e-9);  // Newton stops at 1e-9 residual, Jacobian ~1
    }
  const double h = 1e-6;
  const Point p(0.21, 0.63);
  EXPECT_NEAR((m.jacobian(p).col(0) - (m({p.x() + h, p.y()}) - m({p.x() - h, p.y()})) / (2 * h)).norm(), 0, 1e-8);
}

TEST(Transform, FoldsAndSingularMapsAreRefused) {
  Transform m;
  m.a = Eigen::Matrix2d::Zero();
  EXPECT_THROW(m.inverse({0.1, 0.1}), WorkError);
  Transform fold;
  fold.u = make_zero_field(0.6, 0.6, 0.1);
  for (int j = 0; j < fold.u.ny; ++j)
    for (int i = 0; i < fold.u.nx; ++i)
      fold.u.cx[static_cast<std::size_t>(j * fold.u.nx + i)] = -1.5 * (i - 1) * 0.1;  // x -> -x/2: orientation reversed
  EXPECT_THROW(fold.inverse({0.1, 0.1}), WorkError);
}

TEST(JacobianRange, KnownStretchIsReadExactly) {
  BSplineField u = make_zero_field(0.6, 0.6, 0.1);
  for (int j = 0; j < u.ny; ++j)
    for (int i = 0; i < u.nx; ++i) {
      u.cx[static_cast<std::size_t>(j * u.nx + i)] = 0.02 * (i - 1) * 0.1;
      u.cy[static_cast<std::size_t>(j * u.nx + i)] = -0.01 * (j - 1) * 0.1;
    }
  const JacobianRange r = jacobian_range(u, 0.59, 0.59, 0.01);
  EXPECT_NEAR(r.min, 1.02 * 0.99, 2e-3);  // the last grid row may sit in the clamped rim, where one axis has slope 0
  EXPECT_NEAR(r.max, 1.02, 2e-2);
  EXPECT_NEAR(jacobian_range(BSplineField{}, 1, 1, 0.1).min, 1, 0);
}

TEST(JacobianRange, ChequerboardFoldIsSeenThoughCentralDifferencesAreZero) {
  // u alternates sign from grid point to grid point, so the central difference at every point is 0 and reports J = 1.
  BSplineField u = make_zero_field(1.0, 1.0, 0.1);
  for (int j = 0; j < u.ny; ++j)
    for (int i = 0; i < u.nx; ++i) u.cx[static_cast<std::size_t>(j * u.nx + i)] = (i % 2 ? 1 : -1) * 0.3;
  // At the control points the spline value is (4/6 - 2/6) * +-0.3 = +-0.1: forward differences are -+2.
  const double central = (u.displacement({0.6, 0.5}).x() - u.displacement({0.4, 0.5}).x()) / 0.2;
  EXPECT_NEAR(central, 0, 1e-12);
  EXPECT_NEAR(jacobian_range(u, 0.9, 0.9, 0.1).min, -1, 1e-9);
  EXPECT_GT(jacobian_range(wavy_field(0.004), 0.6, 1.2, 0.01).min, 0.8);
}
TEST(SlabStretch, IsReadOffAnyTurnAndMirror) {
  const double along = 0.004, across = -0.003, shear = 0.002;
  Eigen::Matrix2d slab_from_graphic;
  slab_from_graphic << 1 + across, shear / 2, shear / 2, 1 + along;
  for (const double angle : {0.0, 0.02, M_PI / 2, M_PI, -M_PI / 2})
    for (const int mirror : {1, -1}) {
      Transform map;
      Eigen::Matrix2d turn;
      turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
      turn.col(0) *= mirror;
      map.a = turn * slab_from_graphic.inverse();
      const SlabStretch s = slab_stretch(map);
      EXPECT_NEAR(s.along, along, 1e-12);
      EXPECT_NEAR(s.across, across, 1e-12);
      EXPECT_NEAR(s.shear, shear, 1e-12);
      const Transform mean = mean_affine(map, 0.6, 1.2, 0.01);
      EXPECT_NEAR((mean.a - map.a).norm(), 0, 1e-9);
    }
  Transform flat;
  flat.a << 1, 0, 0, 0;
  EXPECT_THROW(slab_stretch(flat), WorkError);
}
}  // namespace
}  // namespace venato::sync
