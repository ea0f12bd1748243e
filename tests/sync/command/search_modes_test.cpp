// The slab may lie turned, mirrored or anywhere in a larger graphic.
#include <Eigen/LU>

#include "tests/sync/command/run_sync_fixture.h"

namespace venato::sync {
namespace {
using namespace test;

/// The graphic that is seen through `of_upright`: position in the graphic from position in the upright one (440 x 640 mm).
void write_turned(Case& c, const Eigen::Matrix2d& turn, Point origin, int width, int height) {
  Transform upright;  // from the turned graphic
  upright.a = turn.inverse();
  upright.t = -upright.a * origin;
  c.options.graphic = c.folder.path / "graphic.png";
  graphics::write_png(c.options.graphic, painted(vein_raster(VeinField(5), upright, width, height, 0.001), 2));
  c.options.graphic_pitch_m = 0.001;
  c.truth.a = turn * c.truth.a;
  c.truth.t = turn * c.truth.t + origin;
}
Eigen::Matrix2d matrix(double a, double b, double c, double d) {
  Eigen::Matrix2d m;
  m << a, b, c, d;
  return m;
}
/// What is left of the known map when its waves are taken as what they are on average: its affine part by least squares, as registration finds it.
Lying known_lying() {
  const Transform map = known_map(kWidth_m, kHeight_m);
  Eigen::MatrixXd at(41 * 61, 3), to(41 * 61, 2);
  for (int k = 0; k < 41 * 61; ++k) {
    const Point p(k % 41 * 0.01, k / 41 * 0.01);
    at.row(k) << p.x(), p.y(), 1;
    to.row(k) = map(p).transpose();
  }
  const Eigen::MatrixXd fit = (at.transpose() * at).inverse() * (at.transpose() * to);
  Transform affine;
  affine.a = fit.topRows(2).transpose();
  affine.t = fit.row(2).transpose();
  return how_it_lies(affine);
}
void expect_found(Case& c, int turn_deg, bool mirrored) {
  ASSERT_EQ(c.run(), 0) << c.score().at("registration").dump();
  const json lies = c.score().at("registration").at("graphic_lies");
  EXPECT_EQ(lies.at("turn_deg"), turn_deg);
  EXPECT_EQ(lies.at("mirrored"), mirrored);
  const double rotation = known_lying().rotation_rad * 180 / M_PI;
  EXPECT_GT(rotation, 0.2);
  EXPECT_NEAR(std::abs(lies.at("rotation_deg").get<double>()), rotation, 0.05);
  EXPECT_LT(median_map_error_mm(read_map(c.options.out / "map.csv"), c.truth), 1.0);
}

TEST(SearchModes, HalfTurn) {
  Case c;
  c.write_fractions(5);
  write_turned(c, matrix(-1, 0, 0, -1), Point(0.44, 0.64), 440, 640);
  EXPECT_EQ(c.run(), 1);  // not allowed: not found
  c.options.registration.allow_half_turn = true;
  expect_found(c, 180, false);
}
TEST(SearchModes, QuarterTurns) {
  Case c;
  c.write_fractions(5);
  write_turned(c, matrix(0, 1, -1, 0), Point(0, 0.44), 640, 440);
  EXPECT_EQ(c.run(), 1);
  c.options.registration.allow_quarter_turns = true;
  expect_found(c, 270, false);
}
TEST(SearchModes, Mirrored) {
  Case c;
  c.write_fractions(5);
  write_turned(c, matrix(-1, 0, 0, 1), Point(0.44, 0), 440, 640);
  EXPECT_EQ(c.run(), 1);
  c.options.registration.allow_flip = true;
  expect_found(c, 0, true);
}
TEST(SearchModes, PortionFarInALargerGraphic) {
  Case c;
  c.write_fractions(5);
  write_turned(c, matrix(1, 0, 0, 1), Point(0.55, 0.21), 1100, 950);
  expect_found(c, 0, false);
  const json corner = c.score().at("registration").at("graphic_lies").at("slab_corner_in_graphic_mm");
  const Point moved = known_lying().corner_m * 1e3;
  EXPECT_NEAR(corner[0].get<double>(), 550 + moved.x(), 1.5);
  EXPECT_NEAR(corner[1].get<double>(), 210 + moved.y(), 1.5);
}
}  // namespace
}  // namespace venato::sync
