#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "dem/case.h"

namespace venato::dem {
namespace {
class MeshFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("venato_mesh_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  void expect_refused(const std::filesystem::path& file, const std::string& why) {
    try {
      load_mesh(file, 1e-3);
      FAIL() << "accepted " << file;
    } catch (const UsageError& e) {
      EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
    }
  }
  std::filesystem::path folder_;
};

std::string ascii_triangle(const std::string& last = "0 30 5") {
  return "solid part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 20 0 0\n   vertex " + last +
         "\n  endloop\n endfacet\nendsolid part\n";
}

std::string binary_stl(std::uint32_t claimed, std::uint32_t written) {
  std::string text(80, ' ');
  text.append(reinterpret_cast<const char*>(&claimed), 4);
  for (std::uint32_t k = 0; k < written; ++k) {
    const std::array<float, 12> facet{0, 0, 1, 0, 0, 0, 20, 0, 0, 0, 30, static_cast<float>(k + 5)};
    text.append(reinterpret_cast<const char*>(facet.data()), sizeof facet);
    text.append(2, '\0');
  }
  return text;
}

TEST_F(MeshFiles, ascii_and_binary_stl_in_millimetres) {
  for (const auto& file : {write("a.stl", ascii_triangle()), write("b.stl", binary_stl(1, 1))}) {
    const MeshShape mesh = load_mesh(file, 1e-3);
    ASSERT_EQ(mesh.triangles.size(), 1u) << file;
    EXPECT_NEAR((mesh.triangles[0].b - Vec3(0.020, 0, 0)).norm(), 0, 1e-9);  // single precision in the file
    EXPECT_NEAR((mesh.triangles[0].c - Vec3(0, 0.030, 0.005)).norm(), 0, 1e-9);
  }
}

TEST_F(MeshFiles, obj_quads_become_triangles) {
  const auto file = write("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const MeshShape mesh = load_mesh(file, 1);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
  EXPECT_NEAR(area, 1, 1e-6);
}

TEST_F(MeshFiles, hostile_files_are_refused_by_name) {
  expect_refused(folder_ / "missing.stl", "no such file");
  expect_refused(folder_, "not a regular file");
  expect_refused(write("empty.stl", ""), "empty");
  expect_refused(write("garbage.stl", std::string(300, '\x7f')), "mesh");
  expect_refused(write("garbage2.stl", "solid nothing at all, just a letter to my aunt"), "");
  expect_refused(write("text.obj", "this is no mesh\n"), "");
  expect_refused(write("notes.txt", "hello"), "not a mesh");
  expect_refused(write("nofacet.stl", "solid a\nendsolid a\n"), "");
  expect_refused(write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "");
  expect_refused(write("nan.stl", ascii_triangle("nan 1 0")), "");
  expect_refused(write("lies.stl", binary_stl(4'000'000'000u, 1)), "");
  expect_refused(write("cut.stl", binary_stl(3, 3).substr(0, 150)), "");
  expect_refused(write("flat.stl", ascii_triangle("40 0 0")), "no triangle");
}

TEST_F(MeshFiles, nan_in_a_binary_file_is_refused) {
  std::string bytes = binary_stl(1, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84 + 12, &nan, 4);  // x of the first corner
  expect_refused(write("nan_binary.stl", bytes), "finite");
}

TEST_F(MeshFiles, too_many_triangles_are_refused) { expect_refused(write("huge.stl", binary_stl(2'000'001, 2'000'001)), "simplify"); }

TEST_F(MeshFiles, scale_must_be_positive) {
  const auto file = write("a.stl", ascii_triangle());
  EXPECT_THROW(load_mesh(file, 0), UsageError);
  EXPECT_THROW(load_mesh(file, std::numeric_limits<double>::quiet_NaN()), UsageError);
}

TEST(ExtrudeProfile, two_triangles_per_segment_cover_the_strip) {
  const MeshShape mesh = extrude_profile({{0, 0}, {0.03, 0.04}, {0.03, 0.10}}, -0.01, 0.02);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    area += 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
    for (const Vec3& p : {t.a, t.b, t.c}) EXPECT_TRUE(p.x() == -0.01 || p.x() == 0.02);
  }
  EXPECT_NEAR(area, 0.03 * (0.05 + 0.06), 1e-15);
}

TEST(ExtrudeProfile, refuses_profiles_that_are_none) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(extrude_profile({{0, 0}}, 0, 1), UsageError);
  EXPECT_THROW(extrude_profile({{0, 0}, {0, 0}}, 0, 1), UsageError);
  EXPECT_THROW(extrude_profile({{0, 0}, {nan, 0}}, 0, 1), UsageError);
  EXPECT_THROW(extrude_profile({{0, 0}, {1, 0}}, 1, 1), UsageError);
  EXPECT_THROW(extrude_profile({{0, 0}, {1, 0}}, nan, 1), UsageError);
}

double area_of(const MeshShape& mesh, Vec3* vector = nullptr) {
  double area = 0;
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = 0.5 * (t.b - t.a).cross(t.c - t.a);
    area += n.norm(), sum += n;
  }
  if (vector) *vector = sum;
  return area;
}
TEST(Ring, has_the_area_and_place_of_its_circles) {
  const Vec3 centre(1, 2, 3), normal(1, -2, 2);
  Vec3 direction;
  const MeshShape ring = make_ring(centre, normal, 0.3, 0.5);
  // The polygons have the circles' areas: rounding only.
  EXPECT_NEAR(area_of(ring, &direction), M_PI * (0.25 - 0.09), 1e-12);
  EXPECT_NEAR(direction.normalized().cross(normal.normalized()).norm(), 0, 1e-12);  // all in one plane, one way round
  EXPECT_NEAR(direction.norm(), M_PI * (0.25 - 0.09), 1e-12);
  for (const Triangle& t : ring.triangles)
    for (const Vec3& p : {t.a, t.b, t.c}) {
      EXPECT_NEAR((p - centre).dot(normal.normalized()), 0, 1e-12);
      const double r = (p - centre).norm();
      EXPECT_TRUE(std::abs(r - 0.3) < 1e-3 || std::abs(r - 0.5) < 1.5e-3) << r;  // 64 corners: sqrt(x / sin x) - 1 = 0.16 %
    }
  EXPECT_NEAR(area_of(make_ring(centre, normal, 0, 0.5, 12)), M_PI * 0.25, 1e-12);
  EXPECT_THROW(make_ring(centre, Vec3::Zero(), 0, 1), UsageError);
  EXPECT_THROW(make_ring(centre, normal, 0.5, 0.5), UsageError);
  EXPECT_THROW(make_ring(centre, normal, -0.1, 0.5), UsageError);
  EXPECT_THROW(make_ring(centre, normal, 0.1, std::nan("")), UsageError);
  EXPECT_THROW(make_ring(centre, normal, 0.1, 0.5, 3), UsageError);
}
}  // namespace
}  // namespace venato::dem
