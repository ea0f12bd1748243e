#include <algorithm>

#include "graphics/raster/mask.h"
#include "tests/graphics/rectify/camera_fixture.h"
namespace venato::graphics {
namespace {
using namespace test;
using V = Eigen::Vector2d;

double smooth_scene(const V& m) { return 128 + 60 * std::sin(60 * m.x() + 1) + 50 * std::cos(45 * m.y()); }

Raster8 seen(const Pinhole& camera) {
  Raster8 out(camera.width_px, camera.height_px, 1, 1);
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i) {
      V m;
      if (camera.slab_m(V(i, j), m)) out.at(i, j) = static_cast<std::uint8_t>(std::clamp(smooth_scene(m) + 0.5, 0.0, 255.0));
    }
  return out;
}

TEST(Rectify, SmoothSceneComesBack) {
  const Pinhole camera;
  const Rectified r = rectify(seen(camera), camera.view(), 2);
  EXPECT_EQ(r.picture.width, 800);
  EXPECT_EQ(r.picture.height, 1200);
  EXPECT_EQ(r.visible, 1);
  double worst = 0;
  for (int j = 0; j < r.picture.height; ++j)
    for (int i = 0; i < r.picture.width; ++i)
      worst = std::max(worst, std::abs(r.picture.at(i, j) - smooth_scene(V((i + 0.5) * 5e-4, (j + 0.5) * 5e-4))));
  // Rounded twice to whole levels: 1. The scene's slope is 1.8 levels per pixel: a shift of half a pixel would show.
  EXPECT_LE(worst, 1.1);
}

TEST(Rectify, WithoutTheLensItIsOff) {  // negative control of the test above
  const Pinhole camera;
  CameraView view = camera.view();
  view.lens.reset();
  const Rectified r = rectify(seen(camera), view, 2);
  double worst = 0;
  for (int j = 0; j < r.picture.height; ++j)
    for (int i = 0; i < r.picture.width; ++i)
      if (r.valid.at(i, j)) worst = std::max(worst, std::abs(r.picture.at(i, j) - smooth_scene(V((i + 0.5) * 5e-4, (j + 0.5) * 5e-4))));
  EXPECT_GT(worst, 3);
}

TEST(Rectify, SameBytesForAnyThreadCount) {
  const Pinhole camera;
  const Raster8 picture = seen(camera);
  const Rectified one = rectify(picture, camera.view(), 1), three = rectify(picture, camera.view(), 3);
  EXPECT_EQ(one.picture.data, three.picture.data);
  EXPECT_EQ(one.valid.data, three.valid.data);
}

TEST(Rectify, FineGrainIsAveraged) {  // a chequer of single camera pixels becomes its mean, not a moire
  Raster8 chequer(2000, 2000, 1, 1);
  for (int j = 0; j < 2000; ++j)
    for (int i = 0; i < 2000; ++i) chequer.at(i, j) = (i + j) % 2 ? 200 : 100;
  CameraView view;
  view.width_m = view.height_m = 0.2, view.pitch_m = 0.00043;
  view.slab_m_from_ideal_px << 1e-4, 0, 5e-5, 0, 1e-4, 5e-5, 0, 0, 1;
  const Rectified r = rectify(chequer, view, 2);
  EXPECT_GT(r.visible, 0.99);
  for (std::size_t k = 0; k < r.picture.data.size(); ++k)
    if (r.valid.data[k]) {
      ASSERT_NEAR(r.picture.data[k], 150, 13);  // boxes 4.3 px wide leave (1/4.3)^2 of the amplitude of 50, samples instead of areas somewhat more
    }
}

TEST(Rectify, WhatTheCameraDidNotSeeIsNotValid) {
  const Pinhole camera;
  Raster8 picture = seen(camera), cut(camera.width_px, 1000, 1, 1);
  std::copy_n(picture.data.begin(), cut.data.size(), cut.data.begin());
  CameraView view = camera.view({{0, 0}, {0.4, 0}, {0.4, 0.3}, {0, 0.3}});
  view.margin_m = 0.010;
  const Rectified r = rectify(cut, view, 2);
  EXPECT_EQ(r.valid.at(19, 400), 0);
  EXPECT_EQ(r.valid.at(20, 400), 255);
  EXPECT_EQ(r.valid.at(400, 1100), 0);
  EXPECT_GT(r.visible, 0.4);
  EXPECT_LT(r.visible, 0.8);
  const Raster8 full = continued_outside(r.picture, r.valid);
  EXPECT_EQ(full.at(0, 400), r.picture.at(20, 400));
  EXPECT_EQ(full.at(20, 400), r.picture.at(20, 400));
}

TEST(SolveView, MarksResidual) {
  const Pinhole camera;
  CameraView view = camera.view({{0, 0}, {0.4, 0}, {0.4, 0.6}, {0, 0.6}, {0.2, 0.3}, {0.2, 0}});
  SolvedView v = solve_view(view, camera.width_px, camera.height_px);
  EXPECT_EQ(v.marks, 6);
  EXPECT_LT(v.mark_max_m, 1e-9);
  EXPECT_NEAR(v.finest_m_px, 4e-4, 4e-5);
  EXPECT_GT(v.coarsest_m_px, v.finest_m_px);
  view.marks[4].picture_px.x() += 5;  // 2 mm
  expect_usage_error([&] { solve_view(view, camera.width_px, camera.height_px); }, "camera.json", "mark_limit_mm");
  view.mark_limit_m = 0.005;
  EXPECT_GT(solve_view(view, camera.width_px, camera.height_px).mark_max_m, 0.0008);
}

TEST(SolveView, BadMarksAndHomographiesAreRefused) {
  const Pinhole camera;
  const auto refused = [&](CameraView v, const std::string& reason) {
    expect_usage_error([&] { solve_view(v, camera.width_px, camera.height_px); }, "camera.json", reason);
  };
  CameraView v = camera.view();
  std::swap(v.marks[0].picture_px, v.marks[1].picture_px);
  refused(v, "horizon");
  v = camera.view();
  std::swap(v.marks[0].picture_px, v.marks[2].picture_px);
  refused(v, "mirror image");
  v = camera.view();
  v.marks[2].picture_px = v.marks[1].picture_px + V(0.5, 0.5);
  refused(v, "same place");
  v = camera.view();
  v.marks[2].picture_px = (v.marks[0].picture_px + v.marks[1].picture_px) / 2;
  refused(v, "one line");
  v = camera.view();
  v.marks[3].picture_px.y() = 1750;
  refused(v, "/marks/3/px");
  v = camera.view();
  v.marks.clear();
  v.lens.reset();
  v.slab_m_from_ideal_px << 1, 2, 3, 2, 4, 6, 0, 0, 1;
  refused(v, "no inverse");
  v.slab_m_from_ideal_px << -4e-4, 0, 0.4, 0, 4e-4, 0, 0, 0, 1;
  refused(v, "mirror image");
  v = camera.view();
  v.lens->k1 = -30;
  refused(v, "folds back");
}

struct Hostile {
  const char *from, *to, *reason;
};
TEST(ReadCamera, RoundTripAndMistakes) {
  TempFolder folder;
  const auto file = folder / "camera.json";
  const Pinhole camera;
  const std::string good = camera_json(camera.view());
  spill(file, good);
  const CameraView v = read_camera(file);
  EXPECT_EQ(v.width_m, 0.4);
  EXPECT_EQ(v.pitch_m, 0.0005);
  ASSERT_EQ(v.marks.size(), 4u);
  EXPECT_LT((v.marks[2].picture_px - camera.view().marks[2].picture_px).norm(), 1e-12);
  EXPECT_EQ(v.lens->p2, camera.lens.p2);
  for (const Hostile& h :
       {Hostile{"pitch_mm", "pich_mm", "did you mean 'pitch_mm'"}, Hostile{"\"marks\"", "\"mark\"", "four marks or more"},
        Hostile{"[400,600]", "[400,NaN]", "line 1"}, Hostile{"[400,600]", "[400,1e300]", "/slab_mm/1"}, Hostile{"[400,600]", "[400]", "/slab_mm"},
        Hostile{"\"k1\":", "\"k1\":1e999,\"k7\":", "k1"}, Hostile{"\"fx_px\":2600", "\"fx_px\":0", "/lens/fx_px"},
        Hostile{"\"marks\":[", "\"marks\":[[],", "/marks/0"}, Hostile{"\"version\":1", "\"version\":2", "/version"},
        Hostile{"\"marks\"", "\"mm_from_px\":[1,0,0,0,1,0,0,0,1],\"marks\"", "both given"},
        Hostile{"[400,600],\"pitch_mm\":0.5", "[10000,10000],\"pitch_mm\":0.05", "2.5e8 px"}}) {
    std::string bad = good;
    const auto at = bad.find(h.from);
    ASSERT_NE(at, std::string::npos) << h.from;
    bad.replace(at, std::string(h.from).size(), h.to);
    spill(file, bad);
    expect_usage_error([&] { read_camera(file); }, file, h.reason);
  }
  for (const std::string& bytes : {std::string(), std::string("not json"), std::string("[]"), std::string(100, '\0')}) {
    spill(file, bytes);
    EXPECT_THROW(read_camera(file), UsageError);
  }
  EXPECT_THROW(read_camera(folder / "missing.json"), UsageError);
  EXPECT_THROW(read_camera(folder.path), UsageError);
}

TEST(ReadCamera, TheExampleIsGood) {
  const CameraView v = read_camera(VENATO_SOURCE_DIR "/configs/camera/overhead.json");
  EXPECT_GT(solve_view(v, 1400, 1750).finest_m_px, 3e-4);
}
}  // namespace
}  // namespace venato::graphics
