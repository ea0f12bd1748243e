#include "dem/case_outputs/case_outputs.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "base/error.h"
#include "base/h5/h5_file.h"
#include "base/io/atomic_file.h"
#include "dem/case_outputs/csv.h"
#include "dem/case_outputs/plots.h"

namespace venato::dem {
namespace {
constexpr double kGrain_kg = 1e-6;

CounterRecord crossing() {
  const Vec3 zero = Vec3::Zero();
  return {0, zero, zero, zero, zero, 0, kGrain_kg, 1e-3, 0, 0};
}

Case small_case() {
  Case c;
  c.name = "small";
  c.seed = 18446744073709551615ull;
  c.duration_s = 1;
  c.coarse_graining = 2;
  c.box = {Vec3::Zero(), Vec3(0.01, 0.02, 0.03), {true, false, false}};
  c.powders.resize(2);
  c.powders[0].name = "white";
  c.powders[1].name = "grey";
  c.counters.resize(1);
  c.counters[0].name = "exit";
  c.walls.resize(2);
  c.walls[0].name = "belt";
  return c;
}

/// One grain every millisecond from 0.1 s to 0.9 s (1 g/s); every fourth is grey; born at 0.
CaseResult small_result() {
  CaseResult r;
  r.time_step_s = 2e-6;
  r.steps = 500'000;
  r.mass_put_in_kg = 1e-3;
  r.mass_removed_kg = 0.8e-3;
  r.mass_left_kg = 0.2e-3;
  r.records.resize(1);
  for (int k = 0; k < 800; ++k) {
    CounterRecord record = crossing();
    record.time_s = 0.1 + 1e-3 * k;
    record.position_m = Vec3(0.001, 0.002, 0.003);
    record.id = k;
    record.species = k % 4 == 3;
    r.records[0].push_back(record);
  }
  r.series.time_s = {0, 0.5, 1};
  for (auto* v :
       {&r.series.grain_count, &r.series.mass_kg, &r.series.kinetic_energy_j, &r.series.mean_contacts, &r.series.max_speed_m_s, &r.series.top_z_m})
    *v = {1, 2, 3};
  r.series.counter_mass_kg = {{0, 0.4e-3, 0.8e-3}};
  r.series.wall_force_n = {{Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9)}, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};
  r.snapshots.resize(1);
  for (int f = 0; f < 4; ++f) {
    Snapshot s;
    s.time_s = 0.01 * f;
    for (int k = 0; k < 10; ++k) {
      s.id.push_back(k);
      s.position_m.emplace_back(0.005, 0.002 * k + 0.001 + 1e-4 * f, 0.0055);
      s.velocity_m_s.emplace_back(0, 0.01, 0);
      s.radius_m.push_back(5e-4f);
      s.species.push_back(k % 2);
    }
    r.snapshots[0].push_back(s);
  }
  GrainRecord g;
  g.id = 4;
  g.diameter_m = 1e-3;
  r.final_state = {g};
  return r;
}

const Kpi& kpi(const std::vector<Kpi>& kpis, const std::string& name) {
  for (const Kpi& k : kpis)
    if (k.name == name) return k;
  throw std::runtime_error("no kpi " + name);
}

TEST(SteadyFlow, constant_flow_with_no_spread) {
  const FlowEstimate flow = steady_flow(small_result().records[0]);
  EXPECT_NEAR(flow.mean_kg_s, 1e-3, 1e-12);
  // 640 grains in 8 blocks of 80: at most one grain moves across each border by rounding, 1 / 80 / sqrt(8).
  EXPECT_LT(flow.standard_error_kg_s, 0.005 * 1e-3);
  // The 80th and 720th grain; rounding of the mass sums may take the next one.
  EXPECT_NEAR(flow.from_s, 0.1 + 0.0795, 0.6e-3);
  EXPECT_NEAR(flow.to_s, 0.1 + 0.7195, 0.6e-3);
}

TEST(SteadyFlow, filling_and_emptying_do_not_count_and_spread_does) {
  auto records = small_result().records[0];
  CounterRecord late = records.back();
  late.time_s = 100;  // one grain that fell much later
  records.push_back(late);
  EXPECT_NEAR(steady_flow(records).mean_kg_s, 1e-3, 2e-5);
  // Three quarters of the mass in the first half of the time, the rest in the second: blocks of about 1.5 and 0.5 of the mean.
  std::vector<CounterRecord> pulsed;
  for (int k = 0; k < 2000; ++k) {
    CounterRecord r = crossing();
    r.time_s = k < 1500 ? k / 1500.0 : 1 + (k - 1500) / 500.0;
    pulsed.push_back(r);
  }
  const FlowEstimate flow = steady_flow(pulsed);
  EXPECT_NEAR(flow.standard_error_kg_s / flow.mean_kg_s, 0.17, 0.04);  // 4 or 5 blocks of each rate: 0.5 / sqrt(8) or a little less
  EXPECT_TRUE(std::isnan(steady_flow({pulsed.begin(), pulsed.begin() + 10}).mean_kg_s));
}

TEST(CaseKpis, shares_times_and_masses) {
  const auto kpis = case_kpis(small_case(), small_result());
  EXPECT_NEAR(kpi(kpis, "exit.mass_g").value, 0.8, 1e-12);
  EXPECT_NEAR(kpi(kpis, "exit.share_white").value, 0.75, 1e-12);
  EXPECT_NEAR(kpi(kpis, "exit.share_grey").value, 0.25, 1e-12);
  EXPECT_NEAR(kpi(kpis, "exit.mean_time_s").value, 0.1 + 0.3995, 1e-9);
  EXPECT_NEAR(kpi(kpis, "exit.mean_residence_s").value, 0.1 + 0.3995, 1e-9);
  EXPECT_NEAR(kpi(kpis, "exit.mass_flow_g_s").value, 1, 1e-9);
  EXPECT_NEAR(kpi(kpis, "time_step_us").value, 2, 1e-12);
  EXPECT_NEAR(kpi(kpis, "mass_left_g").value, 0.2, 1e-12);
}

TEST(Csv, columns_and_rows) {
  const std::string series = series_csv(small_case(), small_result().series);
  std::istringstream lines(series);
  std::string header, first, second;
  std::getline(lines, header), std::getline(lines, first), std::getline(lines, second);
  EXPECT_EQ(header,
            "time_s,grains,mass_g,kinetic_energy_uj,mean_contacts,max_speed_m_s,top_z_mm,exit_mass_g,belt_force_x_n,belt_force_y_n,belt_force_z_n,"
            "wall1_force_x_n,wall1_force_y_n,wall1_force_z_n");
  EXPECT_EQ(second, "0.5,2,2000,2000000,2,2,2000,0.4,4,5,6,0,0,0");
  const std::string counter = counter_csv(small_case(), small_result().records[0]);
  EXPECT_NE(counter.find("\n0.103,1,2,3,0,0,0,1000,1000,grey,3,0,0,0,0\n"), std::string::npos) << counter.substr(0, 600);
  const std::string kpis = kpi_csv({{"a", 1, std::nan(""), "s", "what, it is", "6 wedges"}});
  EXPECT_EQ(kpis, "name,value,standard_error,unit,description,error_from\na,1,,s,\"what, it is\",6 wedges\n");
}

TEST(HeightProfile, velocity_and_solid_fraction_of_a_moving_row) {
  const auto profile = height_profile(small_case(), small_result().snapshots[0]);
  ASSERT_TRUE(profile);
  double solid = 0;
  for (std::size_t j = 0; j < profile->z_mm.size(); ++j) {
    solid += profile->solid_fraction[j];
    if (profile->solid_fraction[j] > 0) {
      EXPECT_NEAR(profile->velocity_y_mm_s[j], 10, 1e-9);
    }
  }
  // All grain volume (10 grains of 1 mm) over the footprint of the box; single-precision radii.
  const double cell_m = (profile->z_mm[1] - profile->z_mm[0]) * 1e-3;
  EXPECT_NEAR(solid * cell_m / (10 * std::numbers::pi / 6 * 1e-9 / (0.01 * 0.02)), 1, 1e-6);
  EXPECT_FALSE(height_profile(small_case(), {}));
}

TEST(CaseOutputs, the_folder_holds_everything_twice_the_same) {
  const auto folder = std::filesystem::temp_directory_path() / ("venato_case_outputs_" + std::to_string(::getpid()));
  write_case_outputs(folder / "a", small_case(), small_result());
  write_case_outputs(folder / "b", small_case(), small_result());
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "a")) {
    ++files;
    EXPECT_EQ(read_file(entry.path()), read_file(folder / "b" / entry.path().filename())) << entry.path();
  }
  EXPECT_EQ(files, 9);
  for (const char* name : {"result.h5", "kpi.csv", "series.csv", "counter_exit.csv", "counter_mass.svg", "flow_rate.svg", "kinetic_energy.svg",
                           "profile_0_velocity.svg", "profile_0_solid_fraction.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder / "a" / name)) << name;

  const H5Reader file(folder / "a/result.h5", "venato-dem-result", 1);
  EXPECT_EQ(file.text_attribute("/", "seed"), "18446744073709551615");
  for (const std::string& name : file.dataset_names()) {
    const H5Meta meta = file.meta(name);
    EXPECT_FALSE(meta.units.empty() || meta.frame.empty() || meta.description.empty()) << name;
    EXPECT_TRUE(!meta.axes.empty() || file.dims(name).empty()) << name;
  }
  EXPECT_EQ(file.doubles("/counters/exit/time_s").size(), 800u);
  EXPECT_EQ(file.dims("/counters/exit/position_m"), (std::vector<std::uint64_t>{800, 3}));
  EXPECT_EQ(file.integers("/snapshots/0/frame_start"), (std::vector<std::int64_t>{0, 10, 20, 30, 40}));
  EXPECT_EQ(file.doubles("/series/wall_force_n")[3], 4);
  EXPECT_EQ(file.doubles("/balance/mass_left_kg"), std::vector<double>{0.2e-3});
  EXPECT_EQ(file.strings("/names/walls"), (std::vector<std::string>{"belt", "wall1"}));
  std::filesystem::remove_all(folder);
}

TEST(CaseOutputs, an_empty_result_is_written_and_a_file_in_the_way_is_named) {
  const auto folder = std::filesystem::temp_directory_path() / ("venato_case_outputs_empty_" + std::to_string(::getpid()));
  Case c;
  c.name = "empty";
  write_case_outputs(folder, c, {});
  EXPECT_TRUE(std::filesystem::exists(folder / "result.h5"));
  try {
    write_case_outputs(folder / "kpi.csv", c, {});
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("kpi.csv"), std::string::npos) << e.what();
  }
  std::filesystem::remove_all(folder);
}
}  // namespace
}  // namespace venato::dem
