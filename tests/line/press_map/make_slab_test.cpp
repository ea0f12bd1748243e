#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "line/press_map/press_map.h"
#include "line/press_map/sample_slab.h"

using namespace venato;
using namespace venato::line;

namespace {
constexpr BedGrid kGrid{100, 150, 4, 1e-3, 0};

PressMapConfig config() {
  PressMapConfig c;
  c.peak_pressure_pa = 40e6;
  c.density_a_kg_m3 = 1442;
  c.density_b_kg_m3 = 136;
  c.lateral_length_factor = 0.5;
  c.springback = 0.005;
  return c;
}
// 24 kg/m2; vein fraction in layer z (bottom 0) at (x, y) by `vein`.
template <class Vein>
Bed bed_with(Vein vein) {
  Bed bed = make_bed(kGrid, {"body", "vein"});
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 150; ++y)
      for (int x = 0; x < 100; ++x) {
        const auto i = static_cast<std::size_t>((z * 150 + y) * 100 + x);
        bed.mass[1][i] = 6 * vein(z, (x + 0.5) * 1e-3, (y + 0.5) * 1e-3);
        bed.mass[0][i] = 6 - bed.mass[1][i];
      }
  return bed;
}
Slab slab_of(const Bed& bed, const CutWindow& cut, double pitch = 1e-3) {
  return make_slab(bed, compute_press_map(bed.areal_mass(), kGrid, config()), cut, pitch, 2);
}
}  // namespace

// Uniform mass: green = pressed / 1.005, cut and turned. Float positions: 1.5e-8 m at 0.1 m.
TEST(MakeSlab, CutWindowAndSpringback) {
  const CutWindow cut{0.02, 0.03, 0.1, 0.06, 0.09};
  const Slab slab = slab_of(bed_with([](int, double, double) { return 0.5; }), cut);
  ASSERT_EQ(slab.belt_from_green_m.width, 60);
  ASSERT_EQ(slab.belt_from_green_m.height, 90);
  for (int j : {0, 40, 89})
    for (int i : {0, 30, 59}) {
      const double gx = (i + 0.5) * 1e-3, gy = (j + 0.5) * 1e-3;
      EXPECT_NEAR(slab.belt_from_green_m.at(i, j, 0), (0.02 + gx * std::cos(0.1) - gy * std::sin(0.1)) / 1.005, 1e-8);
      EXPECT_NEAR(slab.belt_from_green_m.at(i, j, 1), (0.03 + gx * std::sin(0.1) + gy * std::cos(0.1)) / 1.005, 1e-8);
      // mass per green area = density * thickness; 24 kg/m2 spread over 1.005^2 as much area. Float: 1e-7.
      EXPECT_NEAR(slab.density_kg_m3.at(i, j) * slab.thickness_m.at(i, j) / (24 / (1.005 * 1.005)), 1, 1e-6);
      EXPECT_NEAR(slab.pressure_pa.at(i, j) / 40e6, 1, 1e-6);
    }
  EXPECT_EQ(slab.in_plane_scale, 1.005);
  EXPECT_THROW(slab_of(bed_with([](int, double, double) { return 0.5; }), {0.05, 0.0, 0, 0.06, 0.1}), UsageError);     // 5 mm too wide
  EXPECT_THROW(slab_of(bed_with([](int, double, double) { return 0.5; }), {0.02, 0.0, 0.8, 0.06, 0.14}), UsageError);  // turned out of the strip
}

// Layers at 0.1, 0.3, 0.5, 0.7 from the bottom up: fraction at mass above u is linear between layer middles u = 1/8, 3/8 …, flat beyond. Float: 1e-7.
TEST(SampleSlab, DepthIsMassCoordinate) {
  const Slab slab = slab_of(bed_with([](int z, double, double) { return 0.1 + 0.2 * z; }), {0.01, 0.01, 0, 0.05, 0.05});
  const double h = slab.thickness_m.at(0, 0);
  for (const auto& [above, expected] : {std::pair{0.0, 0.7}, {0.125, 0.7}, {0.25, 0.6}, {0.5, 0.4}, {0.625, 0.3}, {0.8, 0.16}, {0.99, 0.1}}) {
    const auto map = sample_layer_fraction(slab, above * h, 0);
    for (std::size_t p = 0; p < map.data.size(); p += 2) {
      ASSERT_NEAR(map.data[p + 1], expected, 1e-6) << above;
      ASSERT_NEAR(map.data[p] + map.data[p + 1], 1, 1e-6);
    }
  }
  EXPECT_THROW(sample_layer_fraction(slab, 1.01 * h, 0), UsageError);
  EXPECT_THROW(sample_layer_fraction(slab, -1e-6, 0), UsageError);
}

// An inclined vein edge, domain.md 1.3: in the loose bed (24 kg/m2 at 1000 kg/m3: 24 mm) at angle atan(24 / 18), so 18 mm run; pressed by R = loose /
// pressed thickness the run stays and tan(angle) falls by R.
TEST(SampleSlab, PressingFlattensAnInclinedEdge) {
  const Slab slab = slab_of(bed_with([](int z, double, double y) {
                              const double edge = 0.06 + 0.018 * (z + 0.5) / 4;
                              return std::clamp((edge - y) / 1e-3 + 0.5, 0.0, 1.0);
                            }),
                            {0, 0, 0, 0.1, 0.15});
  const auto edge_at = [&](double depth) {
    const auto map = sample_layer_fraction(slab, depth, 0);
    double position = 0;  // integral of the vein fraction = edge position
    for (int j = 0; j < map.height; ++j) position += map.at(50, j, 1) * map.pitch_m;
    return position;
  };
  const double h = slab.thickness_m.at(0, 0), top = edge_at(0.125 * h), bottom = edge_at(0.875 * h);
  const double loose_tan = 24.0 / 18, pressed_tan = 0.75 * h / ((top - bottom) / slab.in_plane_scale);
  EXPECT_NEAR(pressed_tan / (loose_tan / (0.024 / h)), 1, 0.005);  // green pixels vs belt cells: a few um in 13.5 mm
}

TEST(SampleSlab, SectionShowsTheFaceOnTop) {
  const Slab slab = slab_of(bed_with([](int z, double x, double) { return z == 3 && x > 0.05 ? 1.0 : 0.0; }), {0.01, 0.01, 0, 0.08, 0.1});
  const auto section = sample_section(slab, 0, 0.05, 0.08, 0.05, 0.5e-3);
  EXPECT_EQ(section.width, 160);
  EXPECT_EQ(section.height, static_cast<int>(std::ceil(slab.thickness_m.at(0, 0) / 0.5e-3)));
  EXPECT_NEAR(section.at(150, 0, 1), 1, 1e-6);
  EXPECT_NEAR(section.at(10, 0, 1), 0, 1e-6);
  EXPECT_NEAR(section.at(150, section.height - 1, 1), 0, 1e-6);
  EXPECT_NEAR(section.at(150, section.height - 1, 0), 1, 1e-6);
  EXPECT_THROW(sample_section(slab, 0, 0.05, 0.09, 0.05, 1e-3), UsageError);
  EXPECT_THROW(sample_section(slab, 0, 0.05, 0, 0.05, 1e-3), UsageError);
}

// The non-affine blur widens a sharp edge to a Gaussian one: 10-90 % width 2.563 sigma, and keeps the sum of fractions and the vein's area.
TEST(SampleSlab, NonAffineBlur) {
  Slab slab = slab_of(bed_with([](int, double x, double) { return x < 0.05 ? 1.0 : 0.0; }), {0, 0, 0, 0.1, 0.05}, 0.25e-3);
  slab.sigma_nonaffine_m = 2e-3;
  const auto sharp = sample_layer_fraction(slab, 0, 0), soft = sample_layer_fraction(slab, 0);
  const auto crossing = [&](const graphics::RasterF& map, double level) {
    for (int i = 1; i < map.width; ++i)
      if (const double a = map.at(i - 1, 80, 1), b = map.at(i, 80, 1); b < level) return (i - 0.5 + (a - level) / (a - b)) * map.pitch_m;
    return 0.0;
  };
  // The unblurred edge is a ramp of one bed cell: its variance 1/12 mm^2 (2 % of 4) is in the expectation.
  EXPECT_NEAR((crossing(soft, 0.1) - crossing(soft, 0.9)) / (2.563 * std::sqrt(4e-6 + 1e-6 / 12)), 1, 0.01);
  EXPECT_NEAR(crossing(soft, 0.5), crossing(sharp, 0.5), 2e-5);
  double area_sharp = 0, area_soft = 0;
  for (std::size_t p = 1; p < soft.data.size(); p += 2) {
    area_sharp += sharp.data[p];
    area_soft += soft.data[p];
    ASSERT_NEAR(soft.data[p] + soft.data[p - 1], 1, 1e-6);
  }
  EXPECT_NEAR(area_soft / area_sharp, 1, 1e-6);
}
