// Every case in configs/dem runs: here a coarse and short variant of each, in seconds; the full ones in ready_cases_long_test.cpp.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "dem/case_outputs/case_outputs.h"
#include "dem/case_reader.h"

namespace venato::dem {
namespace {
TEST(ReadyCases, each_runs_and_leaves_its_folder) {
  const auto folder = std::filesystem::temp_directory_path() / ("venato_ready_cases_" + std::to_string(::getpid()));
  const auto log = make_null_log();
  const auto progress = make_null_progress();
  Store store(folder / "store");
  int cases = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(VENATO_SOURCE_DIR) / "configs/dem")) {
    if (entry.path().extension() != ".json") continue;
    ++cases;
    // Coarse graining 3.3 is what the narrow boxes still take; 20 ms see grains fall and land.
    const Case c = load_case(
        entry.path(), {{"/coarse_graining", "3.3"}, {"/snapshots", R"([{"from_s":0.01,"to_s":0.02,"every_s":0.002}])"}, {"/vtk/every_s", "0.01"}});
    Context context{*log, *progress, store, c.seed, 1, nullptr};
    RunOptions options;
    options.until_s = 0.0201;
    options.vtk_folder = folder / entry.path().stem() / "vtk";
    const CaseResult result = run_case(c, options, context);
    const double left = result.mass_put_in_kg - result.mass_removed_kg - result.mass_lost_box_kg;
    EXPECT_FALSE(result.complete);
    EXPECT_GT(result.mass_put_in_kg, 0.05e-3);
    EXPECT_NEAR(result.mass_left_kg / left, 1, 1e-12);  // the book closes to rounding
    EXPECT_EQ(result.mass_lost_box_kg, 0);
    write_case_outputs(folder / entry.path().stem(), c, result);
    for (const char* name : {"result.h5", "kpi.csv", "series.csv", "profile_0_velocity.svg", "vtk/grains.pvd", "vtk/grains_000001.vtp"})
      EXPECT_TRUE(std::filesystem::exists(folder / entry.path().stem() / name)) << name;
  }
  EXPECT_GE(cases, 2);
  std::filesystem::remove_all(folder);
}
TEST(ReadyCases, a_fill_without_a_mass_holds_about_what_the_estimate_says) {
  const auto log = make_null_log();
  const auto progress = make_null_progress();
  const auto folder = std::filesystem::temp_directory_path() / ("venato_ready_cases_fill_" + std::to_string(::getpid()));
  Store store(folder);
  const Case c =
      load_case(std::filesystem::path(VENATO_SOURCE_DIR) / "configs/dem/slot_hopper.json", {{"/fills/0/mass_g", "0"}, {"/snapshots", "[]"}});
  Context context{*log, *progress, store, c.seed, 1, nullptr};
  RunOptions options;
  options.until_s = 0.0001;
  const CaseResult result = run_case(c, options, context);
  // It is an estimate of cost: whole rows and layers and the widest grain of each are not counted one by one.
  EXPECT_NEAR(static_cast<double>(result.final_state.size()) / estimate_cost(c, 1).particles, 1, 0.15);
  std::filesystem::remove_all(folder);
}
}  // namespace
}  // namespace venato::dem
