// Homography and lens against closed forms and OpenCV.
#include <opencv2/calib3d.hpp>

#include "tests/graphics/rectify/camera_fixture.h"
namespace venato::graphics {
namespace {
using namespace test;
using V = Eigen::Vector2d;

TEST(Homography, FourPointsAreMetAndTheClosedFormIsFound) {
  // Unit square to the quadrilateral (0,0) (1,0) (2,2) (0,1), closed form (Heckbert 1989): dx1 = -1, dx2 = -2, sx = 1; dy1 = -2, dy2 = -1, sy = 1;
  // det = dx1 dy2 - dx2 dy1 = -3; g = (sx dy2 - dx2 sy) / det = -1/3; h = (dx1 sy - sx dy1) / det = -1/3.
  const auto h = fit_homography({V(0, 0), V(1, 0), V(1, 1), V(0, 1)}, {V(0, 0), V(1, 0), V(2, 2), V(0, 1)});
  ASSERT_TRUE(h);
  Eigen::Matrix3d expected;
  expected << 2.0 / 3, 0, 0, 0, 2.0 / 3, 0, -1.0 / 3, -1.0 / 3, 1;
  EXPECT_LT((*h / (*h)(2, 2) - expected).cwiseAbs().maxCoeff(), 1e-12);
  const Pinhole camera;
  std::vector<V> slab, px;
  for (const V& p : {V(0, 0), V(0.4, 0), V(0.4, 0.6), V(0, 0.6)}) slab.push_back(p), px.push_back(project(camera.ideal_px_from_slab_m, p));
  const auto found = fit_homography(slab, px);
  ASSERT_TRUE(found);
  for (double x = 0; x <= 0.4; x += 0.1)
    for (double y = 0; y <= 0.6; y += 0.1) EXPECT_LT((project(*found, V(x, y)) - project(camera.ideal_px_from_slab_m, V(x, y))).norm(), 1e-9);
}

TEST(Homography, ManyPointsLeastSquares) {
  const Pinhole camera(15);
  std::vector<V> slab, px;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 4; ++i) {
      slab.emplace_back(0.13 * i, 0.15 * j);
      px.push_back(project(camera.ideal_px_from_slab_m, slab.back()) + V((i * 7 + j * 3) % 5 - 2, (i * 2 + j * 5) % 5 - 2) * 0.3);
    }
  const auto h = fit_homography(slab, px);
  ASSERT_TRUE(h);
  const auto cost = [&](const Eigen::Matrix3d& m) {
    double sum = 0;
    for (std::size_t k = 0; k < slab.size(); ++k) sum += (project(m, slab[k]) - px[k]).squaredNorm();
    return sum;
  };
  const double best = cost(*h);
  EXPECT_LT(best, cost(camera.ideal_px_from_slab_m));
  for (int k = 0; k < 9; ++k)  // a minimum: any small change of an element makes it worse
    for (const double change : {-1e-5, 1e-5}) {
      if (k == 8) continue;  // scale
      Eigen::Matrix3d m = *h / (*h)(2, 2);
      m(k / 3, k % 3) *= 1 + change;
      EXPECT_GT(cost(m), best) << k;
    }
}

TEST(Homography, DegeneratePointsHaveNone) {
  EXPECT_FALSE(fit_homography({V(0, 0), V(1, 0), V(2, 0), V(3, 0)}, {V(0, 0), V(1, 0), V(2, 0), V(3, 0)}));
  EXPECT_FALSE(fit_homography({V(0, 0), V(1, 0), V(2, 0), V(0, 1)}, {V(0, 0), V(1, 0), V(2, 0), V(0, 1)}));
  EXPECT_FALSE(fit_homography({V(1, 1), V(1, 1), V(1, 1), V(1, 1)}, {V(0, 0), V(1, 0), V(1, 1), V(0, 1)}));
}

TEST(Lens, IsOpenCvsAndComesBack) {
  const Lens l{2600, 2500, 699.5, 874.5, -0.21, 0.09, -0.03, 4e-4, -7e-4};
  const cv::Matx33d k(l.fx_px, 0, l.cx_px, 0, l.fy_px, l.cy_px, 0, 0, 1);
  const std::vector<double> coefficients{l.k1, l.k2, l.p1, l.p2, l.k3};
  for (double x = 0; x <= 1400; x += 100)
    for (double y = 0; y <= 1750; y += 125) {
      const std::vector<cv::Point3d> ray{{(x - l.cx_px) / l.fx_px, (y - l.cy_px) / l.fy_px, 1}};
      std::vector<cv::Point2d> seen;
      cv::projectPoints(ray, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), k, coefficients, seen);
      const V mine = distorted(l, V(x, y));
      EXPECT_LT(std::hypot(mine.x() - seen[0].x, mine.y() - seen[0].y), 1e-9);
      V back;
      ASSERT_TRUE(undistorted(l, mine, back));
      EXPECT_LT((back - V(x, y)).norm(), 1e-8);
    }
}

TEST(Lens, KnowsWhereItFoldsBack) {
  const Lens l{1000, 1000, 0, 0, -0.5, 0, 0, 0, 0};  // r (1 - r^2/2) grows up to r = sqrt(2/3), where it is 0.544
  EXPECT_NEAR(radius_limit(l, 2), std::sqrt(2.0 / 3), 1e-3);
  V ideal;
  EXPECT_TRUE(undistorted(l, V(540, 0), ideal));
  EXPECT_LT(ideal.x(), 817);
  EXPECT_FALSE(undistorted(l, V(550, 0), ideal));
}
}  // namespace
}  // namespace venato::graphics
