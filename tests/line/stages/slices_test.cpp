// What the stages' DEM slices are made of, and what is measured on them, without running DEM.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/rng.h"
#include "line/stages/belt_transport/slice.h"
#include "line/stages/piezo_discharge/slice.h"
#include "line/stages/powder_feeder/slice.h"
#include "line/stages/press/slice.h"
#include "tests/line/stages/small_line.h"

namespace venato::line {
namespace {

TEST(Slices, EveryStageReadsItsDefaultsAndBuildsACaseThatFitsItsBox) {
  const LineBasics b = small_line();
  const auto piezo = defaults<piezo_discharge::Config>(piezo_discharge::read);
  const auto feeder = defaults<powder_feeder::Config>(powder_feeder::read);
  const auto belt = defaults<belt_transport::Config>(belt_transport::read);
  const auto press_c = defaults<press::Config>(press::read);
  const auto train = piezo_discharge::pulse_train(piezo, b);
  for (const dem::Case& c : {piezo_discharge::make_case(piezo, b, "p", 1, train, 1), powder_feeder::make_case(feeder, b),
                             belt_transport::make_case(belt, b), press::make_case(press_c, b)}) {
    EXPECT_TRUE(c.box.periodic[0]);
    const double largest = b.powders[0].psd.upper_cut_m * c.coarse_graining;
    EXPECT_GE(c.box.high.x() - c.box.low.x(), 2 * largest) << c.name << ": the periodic slice is narrower than two grains";
    for (const dem::Fill& f : c.fills)
      for (int a = 0; a < 3; ++a) {
        EXPECT_GE(f.low[a], c.box.low[a]) << c.name;
        EXPECT_LE(f.high[a], c.box.high[a]) << c.name;
      }
    for (const dem::Rain& r : c.rains) EXPECT_GT(r.low.z(), r.level_z_m) << c.name << ": rain would appear inside the held powder";
    for (const dem::Wall& w : c.walls)
      if (const auto* mesh = std::get_if<dem::MeshShape>(&w.shape)) {
        for (const dem::Triangle& t : mesh->triangles)
          for (const Vec3& p : {t.a, t.b, t.c}) {
            EXPECT_GE(p.y(), c.box.low.y() - 1e-12) << w.name;
            EXPECT_LE(p.y(), c.box.high.y() + 1e-12) << w.name;
          }
      }
    EXPECT_GT(dem::choose_time_step(c), 1e-6) << c.name;
  }
}

TEST(Feeder, OpensOneActuatorAtATimeAndEachOncePerCycle) {
  auto c = defaults<powder_feeder::Config>(powder_feeder::read);
  c.cycles = 3;
  const auto schedule = powder_feeder::feeding_schedule(c, 2);
  ASSERT_EQ(schedule.size(), 2u);
  for (const auto& powder : schedule) EXPECT_EQ(powder.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(schedule[0][static_cast<std::size_t>(k)].off_s + c.gate_travel_time_s, schedule[1][static_cast<std::size_t>(k)].on_s);
    EXPECT_LE(schedule[1][static_cast<std::size_t>(k)].off_s, c.settle_s + (k + 1) * c.cycle_s);
  }
}

TEST(Press, NonAffineScatterSeesScatterAndNotTheCompaction) {
  dem::Snapshot before, after;
  before.time_s = 0, after.time_s = 1;
  Rng rng(3, 77);
  constexpr double kSd = 20e-6;
  for (int k = 0; k < 20000; ++k) {
    const Vec3 p(rng.uniform() * 0.01, rng.uniform() * 0.01, rng.uniform() * 0.02);
    before.id.push_back(k);
    before.position_m.push_back(p);
    after.id.push_back(k);
    // Pressed to 60 % of the height, then Gaussian scatter in the plane.
    after.position_m.push_back(Vec3(p.x() + kSd * rng.normal(), p.y() + 2 * kSd * rng.normal(), 0.6 * p.z()));
  }
  const press::NonAffine n = press::non_affine_scatter(before, after, 6);
  EXPECT_NEAR(n.sd_x_m, kSd, 0.02 * kSd);  // 20000 samples: 0.5 % per standard error
  EXPECT_NEAR(n.sd_y_m, 2 * kSd, 0.02 * 2 * kSd);
  EXPECT_NEAR(n.strain, 0.4, 1e-3);
}

TEST(Press, TooFewGrainsAreAnError) {
  dem::Snapshot one;
  one.id = {1};
  one.position_m = {Vec3(0, 0, 1)};
  EXPECT_THROW(press::non_affine_scatter(one, one, 4), WorkError);
}

TEST(Slices, WarnsWithNumbersWhenAnOpeningIsTooNarrowForTheCoarseGrains) {
  const LineBasics b = small_line();
  SliceNumerics n;
  n.coarse_graining = 4;
  std::vector<std::string> warnings;
  warn_if_too_coarse(b, 0, n, "slot", 0.05, warnings);
  EXPECT_TRUE(warnings.empty());
  warn_if_too_coarse(b, 0, n, "slot", 0.004, warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("slot of 4 mm is "), std::string::npos) << warnings[0];
}
}  // namespace
}  // namespace venato::line
