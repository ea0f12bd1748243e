// The stages' slices really run: what a user of the demo relies on, with limits wide enough for one seed of a small slice.
#include <gtest/gtest.h>

#include <filesystem>

#include "base/store/store.h"
#include "line/stages/belt_transport/slice.h"
#include "line/stages/piezo_discharge/slice.h"
#include "line/stages/powder_feeder/slice.h"
#include "line/stages/press/slice.h"
#include "tests/line/stages/small_line.h"

namespace venato::line {
namespace {

struct Bench {
  std::unique_ptr<Log> log = make_null_log();
  std::unique_ptr<Progress> progress = make_null_progress();
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("venato_characterise_" + std::to_string(::getpid()));
  Store store{folder / "store"};
  Context context{*log, *progress, store, 1, 2, nullptr};
  Bench() { std::filesystem::create_directories(folder); }
  ~Bench() { std::filesystem::remove_all(folder); }
};

double sum_of(const Operator& op) {
  double s = 0;
  for (const double w : op.weight) s += w;
  return s;
}

TEST(Characterise, PiezoDischargeSealsAtRestAndFlowsWithTheDrive) {
  Bench bench;
  auto c = defaults<piezo_discharge::Config>(piezo_discharge::read);
  c.pulses = 6;
  c.drive_levels = {0.4};
  const Operator op = piezo_discharge::characterise(c, small_line(), bench.folder, bench.context);
  EXPECT_NEAR(sum_of(op), 1.0, 1e-9);
  EXPECT_LT(op.figures.at("leak_kg_s"), 0.03 * op.figures.at("mass_flow_kg_s"));  // VB1: shut means shut (the heap's first grains aside)
  const auto& flow = op.curves.at("flow against drive").at("mass_flow_g_s");
  ASSERT_EQ(flow.size(), 3u);
  EXPECT_LT(flow[1], 0.8 * flow[2]);  // less drive, less flow
  // Free fall of 30 mm takes 78 ms; no grain can be on the belt before, all should be within a quarter of a second.
  EXPECT_GT(op.reference_delay_s, 0.05);
  EXPECT_LT(op.reference_delay_s, 0.25);
}

TEST(Characterise, FeederKeepsTheFlowWhateverThePowder) {
  Bench bench;
  auto c = defaults<powder_feeder::Config>(powder_feeder::read);
  c.cycles = 1;
  const Operator op = powder_feeder::characterise(c, small_line(), bench.folder, bench.context);
  EXPECT_NEAR(sum_of(op), 1.0, 1e-9);
  EXPECT_LT(op.figures.at("mass_flow_unevenness"), 0.15);  // both powders share sizes and friction: only noise may part them
  EXPECT_GT(op.figures.at("target"), 0.8);
  EXPECT_LE(op.figures.at("target"), 1.0);
}

TEST(Characterise, BeltTransportLaysWhatTheGateLetsThroughAndShearsTheTopForward) {
  Bench bench;
  auto c = defaults<belt_transport::Config>(belt_transport::read);
  c.tracers = 4000;
  const Operator op = belt_transport::characterise(c, small_line(), bench.folder, bench.context);
  // Gate height times bulk density of about 0.9 to 1.15 g/cm3 (solid fraction 0.50 to 0.62 of 1850).
  EXPECT_GT(op.figures.at("areal_mass_kg_m2"), 0.75 * c.gate_m * 1000);
  EXPECT_LT(op.figures.at("areal_mass_kg_m2"), 1.15 * c.gate_m * 1000);
  EXPECT_LT(op.figures.at("top_minus_bottom_delay_s"), 0);  // what leaves the bin last along the belt lies at the bottom
  EXPECT_LT(std::abs(op.figures.at("flux_defect")), 0.08);
  for (int z = 0; z < op.nz_in; ++z) {
    double row = 0, column = 0;
    for (int k = 0; k < op.nz_out; ++k)
      for (int t = 0; t < op.n_theta; ++t)
        for (int e = 0; e < op.n_eta; ++e) row += op.weight[op.index(z, k, t, e)], column += op.weight[op.index(k, z, t, e)];
    EXPECT_NEAR(row, 1.0, 1e-9);
    EXPECT_NEAR(column, 1.0, 1e-9);
  }
}

TEST(Characterise, PressScatterIsBelowAGrain) {
  Bench bench;
  const auto c = defaults<press::Config>(press::read);
  const Operator op = press::characterise(c, small_line(), bench.folder, bench.context);
  EXPECT_GT(op.figures.at("sigma_nonaffine_m"), 0);
  EXPECT_LT(op.figures.at("sigma_nonaffine_m"), 0.0005);  // PR8: sigma <= d
  EXPECT_GT(op.figures.at("height_strain"), 0.15);
}
}  // namespace
}  // namespace venato::line
