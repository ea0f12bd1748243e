/// run_case(): sources, counters, mass book, watch, checkpoints.
#include "dem/run_case.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "base/store/store.h"
#include "tests/dem/engine/scene.h"

namespace venato::dem {
namespace {
struct Bench {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("venato-run-case-" + std::to_string(getpid()));
  std::unique_ptr<Log> log = make_null_log();
  std::unique_ptr<Progress> progress = make_null_progress();
  Store store{folder};
  Context context{*log, *progress, store};
  Bench() { context.threads = 1; }
  ~Bench() { std::filesystem::remove_all(folder); }
};

/// A small hopper: slice with periodic x, sloping mesh walls, a slot, a counter below that removes, floor of the box catching strays.
Case hopper() {
  Case c;
  c.name = "hopper";
  c.box = {Vec3(0, -0.008, -0.006), Vec3(0.004, 0.008, 0.02), {true, false, false}};
  c.materials = scene::powder(0.3, 0.4, 0.1, 0.3);
  c.powders = {{"white", {4e-4, 2.5, 3e-4, 6e-4}, 0}, {"grey", {4.5e-4, 3, 3e-4, 6e-4}, 0}};
  c.coarse_graining = 1.5;
  c.expected_max_speed_m_s = 1;
  c.duration_s = 0.05;
  c.seed = 11;
  for (const double side : {-1.0, 1.0}) {
    Wall w;
    w.name = side < 0 ? "left" : "right";
    w.shape = MeshShape{{{Vec3(0, side * 0.0015, 0), Vec3(0.004, side * 0.0015, 0), Vec3(0.004, side * 0.006, 0.006)},
                         {Vec3(0, side * 0.0015, 0), Vec3(0.004, side * 0.006, 0.006), Vec3(0, side * 0.006, 0.006)}}};
    c.walls.push_back(w);
    Wall v = scene::plane(Vec3(0, side * 0.006, 0), Vec3(0, -side, 0));
    v.name = side < 0 ? "back" : "front";
    c.walls.push_back(v);
  }
  c.fills = {{Vec3(0, -0.005, 0.0065), Vec3(0.004, 0.005, 0.012), {0.5, 0.5}, 4e-5, Vec3(0, 0, -0.1)}};
  c.counters = {{"slot", 2, -0.002, -1, Vec3::Constant(-1), Vec3::Constant(1), false, true},
                {"below", 2, -0.004, -1, Vec3::Constant(-1), Vec3::Constant(1), true, true}};
  c.series.every_s = 0.005;
  c.snapshots = {{0.01, 0.03, 0.005}};
  return c;
}

double last(const std::vector<double>& v) { return v.back(); }
void expect_book(const CaseResult& r) {
  EXPECT_NEAR(r.mass_put_in_kg, r.mass_removed_kg + r.mass_lost_box_kg + r.mass_left_kg,
              1e-13 * r.mass_put_in_kg);  // rounding of a few thousand sums
}

/// Bed on a floor, periodic in x and y, made by a dense fill.
Case dense_bed() {
  Case c;
  c.name = "dense_bed";
  c.box = {Vec3(0, 0, -0.001), Vec3(0.004, 0.004, 0.01), {true, true, false}};
  c.materials = scene::powder(0.3, 0.4, 0.1, 0.3);
  c.powders = {{"white", {4e-4, 2.5, 3e-4, 6e-4}, 0}};
  c.duration_s = 0.01;
  c.series.every_s = 0.0025;
  c.seed = 4;
  c.walls = {scene::plane()};
  Fill fill;
  fill.high = Vec3(0.004, 0.004, 0.005);
  fill.powder_mass_fractions = {1};
  fill.solid_fraction = 0.58;
  c.fills = {fill};
  return c;
}

TEST(RunCase, DenseFillIsABedAtOnce) {
  Bench b;
  const Case c = dense_bed();
  const CaseResult r = run_case(c, {}, b.context);
  const double mass = 0.58 * 0.004 * 0.004 * 0.005 * c.materials.materials[0].density_kg_m3;
  EXPECT_NEAR(r.mass_put_in_kg, mass, 0.5 * 1900 * std::numbers::pi / 6 * std::pow(6e-4, 3));  // nearest whole number of grains: half the largest
  expect_book(r);
  EXPECT_EQ(r.mass_lost_box_kg, 0);
  // A bed that settles from 0.58 to 0.62 at most (random close packing, a floor) sinks 0.32 mm at its top: sqrt(2 g h) = 80 mm/s. Free fall would have
  // 98 mm/s by now.
  EXPECT_LT(r.max_speed_seen_m_s, 0.08);
  EXPECT_LT(r.max_overlap_seen, 0.01);
  EXPECT_GT(last(r.series.mean_contacts), 2);
  b.context.threads = 2;
  const CaseResult two = run_case(c, {}, b.context);
  ASSERT_EQ(two.final_state.size(), r.final_state.size());
  for (std::size_t k = 0; k < r.final_state.size(); ++k) ASSERT_EQ(two.final_state[k].position_m, r.final_state[k].position_m) << k;
}

TEST(RunCase, DenseFillLeavesRoomForWallsAndEarlierGrains) {
  Bench b;
  Case c = dense_bed();
  c.duration_s = 1e-4;
  c.walls.push_back(scene::plane(Vec3(0, 0.002, 0.0025), Vec3(0, 1, 1).normalized()));  // cuts the region in two: about half is left
  c.fills.push_back(c.fills[0]);                                                        // the same region again: next to nothing fits
  const CaseResult r = run_case(c, {}, b.context);
  const double whole = 0.58 * 0.004 * 0.004 * 0.005 * c.materials.materials[0].density_kg_m3;
  EXPECT_GT(r.mass_put_in_kg, 0.35 * whole);
  EXPECT_LT(r.mass_put_in_kg, 0.55 * whole);
  EXPECT_LT(r.max_overlap_seen, 0.01);

  Case impossible = dense_bed();
  impossible.fills[0].solid_fraction = 0.72;
  try {
    run_case(impossible, {}, b.context);
    FAIL() << "packed to 0.72";
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("'dense_bed': fill 0: dense packing"), std::string::npos) << e.what();
  }
  impossible.fills[0].solid_fraction = 0.6;
  impossible.fills[0].mass_kg = 1e-3;
  EXPECT_THROW(run_case(impossible, {}, b.context), UsageError);
}

TEST(RunCase, FillsFlowsCountsAndClosesItsBook) {
  Bench b;
  const Case c = hopper();
  const CaseResult r = run_case(c, {}, b.context);
  EXPECT_NEAR(r.mass_put_in_kg, 4e-5, 2e-7);  // half the largest grain
  expect_book(r);
  EXPECT_GT(r.mass_removed_kg, 0.05 * r.mass_put_in_kg);
  EXPECT_EQ(r.mass_lost_box_kg, 0);
  ASSERT_EQ(r.records.size(), 2u);
  const double counted =
      std::accumulate(r.records[1].begin(), r.records[1].end(), 0.0, [](double s, const CounterRecord& k) { return s + k.mass_kg; });
  EXPECT_NEAR(counted, r.mass_removed_kg, 1e-13 * counted);
  EXPECT_NEAR(last(r.series.counter_mass_kg[0]),
              r.records[0].empty() ? 0
                                   : std::accumulate(r.records[0].begin(), r.records[0].end(), 0.0,
                                                     [](double s, const CounterRecord& k) { return s + (k.time_s <= 0.05 ? k.mass_kg : 0); }),
              5e-2 * counted + 1e-9);
  double before = 0;
  for (const CounterRecord& k : r.records[0]) {
    EXPECT_GE(k.time_s, before);
    before = k.time_s;
    EXPECT_NEAR(k.position_m.z(), -0.002, 1e-15);  // interpolated onto the plane
    EXPECT_LT(k.velocity_m_s.z(), 0);
    EXPECT_TRUE(k.species == 0 || k.species == 1);
    EXPECT_EQ(k.birth_time_s, 0);
    EXPECT_GT(k.birth_position_m.z(), 0.006);
  }
  ASSERT_EQ(r.snapshots[0].size(), 4u);  // 10, 15, 20, 25 ms
  EXPECT_TRUE(std::is_sorted(r.snapshots[0][0].id.begin(), r.snapshots[0][0].id.end()));
  EXPECT_NEAR(r.snapshots[0][1].time_s, 0.015, 2 * r.time_step_s);
  EXPECT_EQ(r.series.time_s.size(), 11u);
  EXPECT_LE(r.max_speed_seen_m_s, 1);
  // both powders, in about the shares asked for (by mass; 1 standard error of ~300 grains is 3 %)
  double white = 0, all = 0;
  for (const GrainRecord& g : r.final_state) (g.species == 0 ? white : all) += std::pow(g.diameter_m, 3);
  EXPECT_NEAR(white / (white + all), 0.5, 0.12);
}

std::uint64_t bytes_of(const CaseResult& r) {
  std::uint64_t h = 1;
  auto add = [&](double v) {
    std::uint64_t u;
    std::memcpy(&u, &v, 8);
    h = (h ^ u) * 1099511628211ull, h ^= h >> 31;
  };
  for (const auto& list : r.records)
    for (const CounterRecord& k : list)
      add(k.time_s), add(k.position_m.x()), add(k.velocity_m_s.y()), add(k.spin_rad_s.z()), add(static_cast<double>(k.id));
  for (const auto* s : {&r.series.time_s, &r.series.kinetic_energy_j, &r.series.mean_contacts, &r.series.top_z_m, &r.series.max_speed_m_s})
    for (const double v : *s) add(v);
  for (const auto& w : r.series.wall_force_n)
    for (const Vec3& f : w) add(f.x()), add(f.y()), add(f.z());
  for (const auto& plan : r.snapshots)
    for (const Snapshot& s : plan)
      for (const Vec3& p : s.position_m) add(p.x()), add(p.y()), add(p.z());
  for (const GrainRecord& g : r.final_state) add(g.position_m.x()), add(g.velocity_m_s.y()), add(g.spin_rad_s.z());
  add(r.mass_left_kg), add(r.mass_put_in_kg), add(r.mass_removed_kg), add(r.particle_steps), add(r.max_overlap_seen);
  for (const double s : r.rain_starved_kg) add(s);
  return h;
}

Case rainy_hopper() {
  Case c = hopper();
  c.duration_s = 0.03;
  c.rains = {{"rain", Vec3(0, -0.004, 0.014), Vec3(0.004, 0.004, 0.018), {0.2, 0.8}, 2e-4, {{0.005, 0.02}}, Vec3(0, 0, -0.2), std::nan("")}};
  return c;
}
/// Interrupted several times = undisturbed; two threads = one.
TEST(RunCase, ResumedAndThreadedRunsGiveTheSameBytes) {
  Bench b;
  const Case c = rainy_hopper();
  const CaseResult whole = run_case(c, {}, b.context);
  b.context.threads = 2;
  EXPECT_EQ(bytes_of(run_case(c, {}, b.context)), bytes_of(whole));
  b.context.threads = 1;
  std::filesystem::create_directories(b.folder);
  RunOptions options;
  options.checkpoint = b.folder / "case.ckpt";
  // A progress sink that asks to stop after some looks: interruptions at places that have nothing to do with the physics.
  struct Stopper : Progress {
    std::atomic<bool> stop{false};
    int looks = 0;
    void begin(std::string_view, double, std::string_view) override { looks = 0; }
    void at(double, std::string_view) override { stop = ++looks > 97; }
    void end() override {}
  } stopper;
  Context context{*b.log, stopper, b.store};
  context.threads = 1;
  context.stop = &stopper.stop;
  int interruptions = 0;
  std::optional<CaseResult> resumed;
  while (!resumed && interruptions < 100) {
    stopper.stop = false;
    try {
      resumed = run_case(c, options, context);
    } catch (const Interrupted&) {
      ++interruptions;
      EXPECT_TRUE(std::filesystem::exists(options.checkpoint));
    }
  }
  ASSERT_TRUE(resumed);
  EXPECT_GE(interruptions, 3);
  EXPECT_EQ(bytes_of(*resumed), bytes_of(whole));
  EXPECT_FALSE(std::filesystem::exists(options.checkpoint));
}
TEST(RunCase, UntilStopsThereAndGoesOnBitForBit) {
  Bench b;
  std::filesystem::create_directories(b.folder);
  const Case c = rainy_hopper();
  const CaseResult whole = run_case(c, {}, b.context);
  EXPECT_TRUE(whole.complete);
  RunOptions options;
  options.checkpoint = b.folder / "case.ckpt";
  options.until_s = 0.0123;
  const CaseResult part = run_case(c, options, b.context);
  EXPECT_FALSE(part.complete);
  EXPECT_NEAR(part.end_time_s, 0.0123, 1.01 * part.time_step_s);
  EXPECT_GE(part.end_time_s, 0.0123 * (1 - 1e-12));
  expect_book(part);
  ASSERT_TRUE(std::filesystem::exists(options.checkpoint));
  // Asking for an earlier time does not go back, and does not change what comes after.
  options.until_s = 0.005;
  EXPECT_NEAR(run_case(c, options, b.context).end_time_s, part.end_time_s, 1e-15);
  options.until_s = 0.02;
  EXPECT_FALSE(run_case(c, options, b.context).complete);
  options.until_s = 0;
  b.context.threads = 2;
  const CaseResult resumed = run_case(c, options, b.context);
  EXPECT_TRUE(resumed.complete);
  EXPECT_EQ(bytes_of(resumed), bytes_of(whole));
  EXPECT_FALSE(std::filesystem::exists(options.checkpoint));
  options.until_s = 1;  // beyond the end: an ordinary run
  EXPECT_EQ(bytes_of(run_case(c, options, b.context)), bytes_of(whole));
}
TEST(RunCase, CheckpointOfAnotherCaseIsRefused) {
  Bench b;
  std::filesystem::create_directories(b.folder);
  Case c = rainy_hopper();
  RunOptions options;
  options.checkpoint = b.folder / "case.ckpt";
  std::atomic<bool> stop{true};
  b.context.stop = &stop;
  EXPECT_THROW(run_case(c, options, b.context), Interrupted);
  stop = false;
  c.seed = 12;
  EXPECT_THROW(run_case(c, options, b.context), UsageError);
}

TEST(RunCase, RainKeepsItsRateAndStopsAtItsLevel) {
  Bench b;
  Case c = hopper();
  c.fills.clear();
  c.counters.clear();
  c.walls.push_back(scene::plane(Vec3(0, 0, 0.002)));
  c.duration_s = 0.1;
  c.rains = {{"rain", Vec3(0, -0.004, 0.012), Vec3(0.004, 0.004, 0.018), {0.5, 0.5}, 1e-3, {{0.01, 0.03}}, Vec3(0, 0, -0.2), std::nan("")}};
  c.expected_max_speed_m_s = 1.5;
  c.duration_s = 0.04;
  const CaseResult r = run_case(c, {}, b.context);
  EXPECT_NEAR(r.mass_put_in_kg, 1e-3 * 0.02, 1e-6);  // one of the largest grains
  EXPECT_EQ(r.rain_starved_kg.size(), 1u);
  expect_book(r);
  // level: the bed may not grow past it by more than what is in the air (0.35 g/s x 50 ms fall at most)
  Case levelled = c;
  levelled.rains[0].when.clear();
  levelled.rains[0].level_z_m = 0.0035;
  levelled.duration_s = 0.12;
  const CaseResult l = run_case(levelled, {}, b.context);
  EXPECT_LT(l.mass_put_in_kg, 0.75 * 1e-3 * 0.12);
  EXPECT_GT(last(l.series.top_z_m), 0.003);
}
TEST(RunCase, RainThatFindsNoRoomIsCountedAsStarved) {
  Bench b;
  Case c = hopper();
  c.fills.clear();
  c.gravity_m_s2 = Vec3::Zero();
  c.duration_s = 0.01;
  c.rains = {{"rain", Vec3(0, -0.001, 0.012), Vec3(0.004, 0.001, 0.013), {1, 0}, 0.01, {}, Vec3::Zero(), std::nan("")}};  // nothing moves away
  const CaseResult r = run_case(c, {}, b.context);
  EXPECT_NEAR(r.mass_put_in_kg + r.rain_starved_kg[0], 1e-4, 0.01 * 64 * r.time_step_s);  // rain falls due every 64 steps
  EXPECT_GT(r.rain_starved_kg[0], 5e-5);
  EXPECT_FALSE(r.warnings.empty());
}
TEST(RunCase, HandedOverGrainsAppearAtTheirTime) {
  Bench b;
  Case c = hopper();
  c.fills.clear();
  c.counters.clear();
  c.gravity_m_s2 = Vec3::Zero();
  c.duration_s = 0.02;
  c.handed_over = {{0.01, Vec3(0.001, 0, 0.01), Vec3(0.1, 0, 0), Vec3(1, 2, 3), 5e-4, 1, 77},
                   {0, Vec3(0.003, 0, 0.01), Vec3::Zero(), Vec3::Zero(), 4e-4, 0, 5}};
  const CaseResult r = run_case(c, {}, b.context);
  ASSERT_EQ(r.final_state.size(), 2u);
  const GrainRecord& g = r.final_state[1];
  EXPECT_EQ(g.species, 1);
  EXPECT_EQ(g.diameter_m, 5e-4);
  EXPECT_EQ(g.spin_rad_s, Vec3(1, 2, 3));
  EXPECT_NEAR(g.position_m.x(), 0.001 + 0.1 * 0.01, 0.1 * 11 * r.time_step_s);  // insertion every 10 steps
  expect_book(r);
}
TEST(RunCase, GrainsLeavingTheBoxAreLostToTheBook) {
  Bench b;
  Case c = hopper();
  c.counters.clear();
  c.walls.clear();
  c.duration_s = 0.06;
  const CaseResult r = run_case(c, {}, b.context);  // everything falls out: 18 mm take 0.05 s from -0.1 m/s
  EXPECT_EQ(r.final_state.size(), 0u);
  EXPECT_NEAR(r.mass_lost_box_kg, r.mass_put_in_kg, 1e-13 * r.mass_put_in_kg);
}

std::string error_of(const Case& c) {
  Bench b;
  try {
    run_case(c, {}, b.context);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}
TEST(RunCase, BlowUpNamesGrainPlaceTimeAndCause) {
  Case c = hopper();
  c.time_step_s = 4e-4;  // far beyond stability
  const std::string text = error_of(c);
  for (const char* part : {"grain ", "powder '", "reached", "m/s at t =", "limit 2 m/s", "likely cause", "try"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  Case crushed = hopper();  // a wall that sweeps through the hopper
  Wall ram = scene::plane(Vec3(0, 0, 0.03), Vec3(0, 0, -1));
  ram.motion.velocity_m_s = Vec3(0, 0, -1.9);
  crushed.walls.push_back(ram);
  crushed.walls.push_back(scene::plane());
  EXPECT_NE(error_of(crushed).find("wall"), std::string::npos) << error_of(crushed);
}
TEST(RunCase, BadCasesAreRefused) {
  auto broken = [](const std::function<void(Case&)>& f) {
    Case c = hopper();
    f(c);
    return error_of(c);
  };
  EXPECT_NE(broken([](Case& c) { c.duration_s = 0; }).find("duration"), std::string::npos);
  EXPECT_NE(broken([](Case& c) { c.fills[0].powder_mass_fractions = {1}; }).find("fill 0"), std::string::npos);
  EXPECT_NE(broken([](Case& c) { c.fills[0].powder_mass_fractions = {0.4, 0.4}; }).find("add up to 1"), std::string::npos);
  EXPECT_NE(broken([](Case& c) { c.fills[0].mass_kg = 1; }).find("holds"), std::string::npos);
  EXPECT_NE(broken([](Case& c) { c.materials.pairs[0].restitution = 0; }).find("restitution"), std::string::npos);
  EXPECT_NE(broken([](Case& c) {
              c.box.high.x() = 0.001;
              c.fills[0].mass_kg = 1e-6;
            }).find("outside the box"),
            std::string::npos);
  EXPECT_NE(broken([](Case& c) { c.walls[0].motion.track = {{1, Vec3::Zero()}, {0, Vec3::Zero()}}; }).find("'left'"), std::string::npos);
}
}  // namespace
}  // namespace venato::dem
