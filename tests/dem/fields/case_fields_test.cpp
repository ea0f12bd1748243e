// "fields" of a DEM case: from the file through the run, an interruption and threads to the datasets in result.h5.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/h5/h5_file.h"
#include "base/store/store.h"
#include "dem/case_outputs/case_outputs.h"
#include "dem/case_reader.h"
#include "dem/fields/field_recorder.h"

namespace venato::dem {
namespace {
const std::filesystem::path kCase = std::filesystem::path(VENATO_SOURCE_DIR) / "configs/dem/slot_hopper.json";
const char* const kFields = R"({"width_mm":0.6,"grid_mm":[8,2,1.5],"from_s":0.02,"to_s":0.04,"every_s":0.004,"diffusivity":true})";

Case short_case(const std::string& fields = kFields) {
  return load_case(kCase, {{"/coarse_graining", "3.3"},
                           {"/duration_s", "0.045"},
                           {"/snapshots", "[]"},
                           {"/fields", fields},
                           {"/rig/openings", R"([{"size_mm":6,"from_s":0.01,"to_s":0.04}])"},
                           {"/rig/settle_s", "0.005"}});  // the rig's window inside the short run
}

struct Bench {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("venato_case_fields_" + std::to_string(::getpid()));
  std::unique_ptr<Log> log = make_null_log();
  std::unique_ptr<Progress> progress = make_null_progress();
  Store store{folder / "store"};
  CaseResult run(const Case& c, int threads = 1, const RunOptions& options = {}, Progress* watch = nullptr, std::atomic<bool>* stop = nullptr) {
    Context context{*log, watch ? *watch : *progress, store, c.seed, threads, stop};
    return run_case(c, options, context);
  }
  ~Bench() { std::filesystem::remove_all(folder); }
};

void expect_same(const FieldResult& a, const FieldResult& b) {
  EXPECT_EQ(a.fields.frames, b.fields.frames);
  EXPECT_EQ(a.fields.density_kg_m3, b.fields.density_kg_m3);
  EXPECT_EQ(a.fields.contact_stress_pa, b.fields.contact_stress_pa);
  EXPECT_EQ(a.plateau.density_kg_m3, b.plateau.density_kg_m3);
  ASSERT_TRUE(a.diffusivity && b.diffusivity);
  EXPECT_EQ(a.diffusivity->samples, b.diffusivity->samples);
}

TEST(CaseFields, hold_the_mass_balance_and_carry_units) {
  Bench b;
  const Case c = short_case();
  const CaseResult r = b.run(c);
  ASSERT_TRUE(r.fields);
  EXPECT_EQ(r.fields->fields.frames, 5);  // 0.02, 0.024, … 0.036
  EXPECT_LT(r.fields->balance_residual, 1e-11);
  double mass = 0;
  for (const double rho : r.fields->fields.density_kg_m3) mass += rho * r.fields->fields.grid.cell_volume_m3();
  EXPECT_NEAR(mass / r.mass_put_in_kg, 1, 1e-12);  // nothing has left the hopper yet
  write_case_outputs(b.folder / "out", c, r);
  for (const char* name : {"fields_plateau.svg", "fields_stress.svg"}) EXPECT_TRUE(std::filesystem::exists(b.folder / "out" / name)) << name;
  const H5Reader file(b.folder / "out/result.h5", "venato-dem-result", 1);
  int seen = 0;
  for (const std::string& name : file.dataset_names()) {
    if (name.rfind("/fields/", 0) != 0) continue;
    ++seen;
    const H5Meta meta = file.meta(name);
    EXPECT_FALSE(meta.units.empty() || meta.frame.empty() || meta.description.empty()) << name;
    const auto commas = static_cast<std::size_t>(std::count(meta.axes.begin(), meta.axes.end(), ','));
    EXPECT_EQ(file.dims(name).size(), meta.axes.empty() ? 0 : commas + 1) << name;
  }
  EXPECT_EQ(seen, 30);
  EXPECT_EQ(file.dims("/fields/contact_stress_pa"), (std::vector<std::uint64_t>{static_cast<std::uint64_t>(r.fields->fields.grid.n[2]),
                                                                                static_cast<std::uint64_t>(r.fields->fields.grid.n[1]), 1, 3, 3}));
}

TEST(CaseFields, are_the_same_for_any_threads_and_after_an_interruption) {
  Bench b;
  const Case c = short_case();
  const CaseResult whole = b.run(c), threaded = b.run(c, 2);
  ASSERT_TRUE(whole.fields && threaded.fields);
  expect_same(*whole.fields, *threaded.fields);
  RunOptions options;
  std::filesystem::create_directories(b.folder);
  options.checkpoint = b.folder / "case.ckpt";
  struct Stopper : Progress {
    std::atomic<bool> stop{false};
    int looks = 0;
    void begin(std::string_view, double, std::string_view) override { looks = 0; }
    void at(double, std::string_view) override { stop = ++looks > 120; }
    void end() override {}
  } stopper;
  std::optional<CaseResult> resumed;
  int interruptions = 0;
  while (!resumed && interruptions < 100) {
    stopper.stop = false;
    try {
      resumed = b.run(c, 1, options, &stopper, &stopper.stop);
    } catch (const Interrupted&) {
      ++interruptions;
    }
  }
  ASSERT_TRUE(resumed && resumed->fields);
  EXPECT_GE(interruptions, 2);
  expect_same(*whole.fields, *resumed->fields);
}

TEST(CaseFields, a_window_after_the_end_gives_none_and_bad_plans_are_refused) {
  Bench b;
  Case c = short_case();
  c.fields->from_s = 1, c.fields->to_s = 2;
  c.duration_s = 0.002;
  EXPECT_FALSE(b.run(c).fields);
  EXPECT_FALSE(load_case(kCase).fields);
  const auto issues_of = [](const char* fields) {
    try {
      short_case(fields);
    } catch (const ConfigError& e) {
      return e.issues().size();
    }
    return std::size_t{0};
  };
  EXPECT_EQ(issues_of(R"({"width_mm":0.6,"grid_mm":[8,2,1.5],"from_s":0.04,"to_s":0.03,"every_s":0.004})"), 1u);
  EXPECT_EQ(issues_of(R"({"width_mm":0.6,"grid_mm":[8,2,1.5],"from_s":1,"to_s":2,"every_s":0.004})"), 1u);
  EXPECT_EQ(issues_of(R"({"width_mm":0.6,"grid_mm":[0.05,0.05,0.05],"from_s":0,"to_s":0.03,"every_s":0.004})"), 1u);
  EXPECT_EQ(issues_of(R"({"width_mm":-1,"grid_mm":[8,2,1.5],"from_s":0,"to_s":0.03,"every_s":0.004})"), 1u);
  EXPECT_EQ(issues_of(R"({"grid_mm":[8,2,1.5],"from_s":0,"to_s":0.03,"every_s":0.004})"), 1u);
}
}  // namespace
}  // namespace venato::dem
