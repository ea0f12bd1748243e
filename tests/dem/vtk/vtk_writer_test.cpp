#include "dem/vtk/vtk_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <numbers>
#include <regex>

#include "base/error.h"
#include "base/io/atomic_file.h"

namespace venato::dem {
namespace {
class VtkFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("venato_vtk_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

/// What a VTK reader does: finds the array's declaration, follows the offset into the appended block, reads the 64-bit count and the values.
template <class T>
std::vector<T> array_of(const std::string& text, const std::string& type, const std::string& name) {
  std::smatch match;
  const std::regex declaration("<DataArray type=\"" + type + "\" Name=\"" + name +
                               "\" NumberOfComponents=\"\\d\" format=\"appended\" offset=\"(\\d+)\"/>");
  const std::string header = text.substr(0, text.find("<AppendedData"));
  if (!std::regex_search(header, match, declaration)) {
    ADD_FAILURE() << "no array " << name;
    return {};
  }
  const std::size_t start = text.find('_', text.find("<AppendedData")) + 1 + std::stoul(match[1]);
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, text.data() + start, sizeof bytes);
  if (start + sizeof bytes + bytes > text.size()) {
    ADD_FAILURE() << name << " runs past the end of the file";
    return {};
  }
  std::vector<T> values(bytes / sizeof(T));
  if (bytes > 0) std::memcpy(values.data(), text.data() + start + sizeof bytes, bytes);
  return values;
}

const std::vector<Vec3> kPosition{Vec3(0.001, 0.002, 0.003), Vec3(-0.004, 0.005, 0.006)}, kVelocity{Vec3(1, 2, 3), Vec3(4, 5, 6)};
const std::vector<double> kRadius{1e-4, 2e-4};
const std::vector<std::int32_t> kSpecies{0, 1};
const std::vector<std::int64_t> kId{7, 5'000'000'000};
VtkGrains grains() { return {kPosition, kVelocity, kRadius, kSpecies, kId}; }

TEST_F(VtkFiles, grains_come_back) {
  write_grains_vtp(folder_ / "g.vtp", grains());
  const std::string text = read_file(folder_ / "g.vtp");
  EXPECT_NE(text.find("NumberOfPoints=\"2\" NumberOfVerts=\"2\""), std::string::npos);
  EXPECT_EQ(array_of<float>(text, "Float32", "position_m"), (std::vector<float>{.001f, .002f, .003f, -.004f, .005f, .006f}));
  EXPECT_EQ(array_of<float>(text, "Float32", "velocity_m_s"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(array_of<float>(text, "Float32", "radius_m"), (std::vector<float>{1e-4f, 2e-4f}));
  EXPECT_EQ(array_of<std::int32_t>(text, "Int32", "species"), kSpecies);
  EXPECT_EQ(array_of<std::int64_t>(text, "Int64", "id"), kId);
  EXPECT_EQ(array_of<std::int32_t>(text, "Int32", "connectivity"), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(array_of<std::int32_t>(text, "Int32", "offsets"), (std::vector<std::int32_t>{1, 2}));
}

TEST_F(VtkFiles, no_grains_is_a_file_too) {
  write_grains_vtp(folder_ / "g.vtp", {});
  const std::string text = read_file(folder_ / "g.vtp");
  EXPECT_NE(text.find("NumberOfPoints=\"0\""), std::string::npos);
  EXPECT_TRUE(array_of<float>(text, "Float32", "position_m").empty());
}

TEST_F(VtkFiles, walls_come_back) {
  const VtkWalls walls{{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)}}, {3, 4}};
  write_walls_vtp(folder_ / "w.vtp", walls);
  const std::string text = read_file(folder_ / "w.vtp");
  EXPECT_EQ(array_of<std::int32_t>(text, "Int32", "wall"), (std::vector<std::int32_t>{3, 4}));
  EXPECT_EQ(array_of<float>(text, "Float32", "position_m").size(), 18u);
  EXPECT_EQ(array_of<std::int32_t>(text, "Int32", "offsets"), (std::vector<std::int32_t>{3, 6}));
}

TEST_F(VtkFiles, frames_and_their_index) {
  write_vtk_frame(folder_, 0, grains(), {});
  write_vtk_frame(folder_, 1, grains(), {});
  const std::vector<double> times{0, 0.02};
  write_vtk_index(folder_, times);
  const std::string pvd = read_file(folder_ / "grains.pvd");
  EXPECT_NE(pvd.find("timestep=\"0.02\" part=\"0\" file=\"grains_000001.vtp\""), std::string::npos) << pvd;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    ++files;
    EXPECT_EQ(entry.path().string().find("partial"), std::string::npos);
  }
  EXPECT_EQ(files, 6);
  EXPECT_EQ(read_file(folder_ / "grains_000000.vtp"), read_file(folder_ / "grains_000001.vtp"));  // same data, same bytes
}

TEST_F(VtkFiles, a_folder_that_is_not_there_is_an_error) { EXPECT_THROW(write_grains_vtp(folder_ / "no/such/g.vtp", grains()), std::runtime_error); }

double area(const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
  return sum;
}

TEST(Tessellate, a_plane_is_the_polygon_in_which_it_cuts_the_box) {
  const Box box{Vec3::Zero(), Vec3(1, 2, 3), {}};
  // The box is enlarged by 1e-9 so that its own faces are shown: that is the tolerance.
  EXPECT_NEAR(area(tessellate(PlaneShape{Vec3(0, 0, 0), Vec3(0, 0, 1)}, box)), 2, 1e-7);
  EXPECT_NEAR(area(tessellate(PlaneShape{Vec3(0, 0, 1.5), Vec3(0, 0, -5)}, box)), 2, 1e-7);
  EXPECT_TRUE(tessellate(PlaneShape{Vec3(0, 0, 4), Vec3(0, 0, 1)}, box).empty());
  const Box cube{Vec3::Zero(), Vec3(1, 1, 1), {}};  // the diagonal cut through its middle is a regular hexagon of side 1/sqrt(2)
  EXPECT_NEAR(area(tessellate(PlaneShape{Vec3(.5, .5, .5), Vec3(1, 1, 1)}, cube)), 3 * std::sqrt(3.0) / 2 * 0.5, 1e-7);
}

TEST(Tessellate, a_cylinder_has_its_area_and_mesh_stays_as_it_is) {
  const CylinderShape cylinder{Vec3(1, 2, 3), Vec3(1, 1, 0), 0.5, 0.1, true};
  const auto facets = tessellate(cylinder, {});
  EXPECT_NEAR(area(facets), 0.5 * 64 * 2 * 0.1 * std::sin(std::numbers::pi / 64), 1e-12);
  for (const Triangle& t : facets)
    for (const Vec3& p : {t.a, t.b, t.c}) {
      const Vec3 axis = cylinder.axis.normalized(), d = p - cylinder.base;
      EXPECT_NEAR((d - d.dot(axis) * axis).norm(), 0.1, 1e-12);
    }
  EXPECT_EQ(tessellate(MeshShape{{{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()}}}, {}).size(), 1u);
}
}  // namespace
}  // namespace venato::dem
