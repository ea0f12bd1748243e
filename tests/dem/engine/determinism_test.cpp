/// Same bytes whatever the threads, the list, the search and interruptions are (house style 16, 17; verification.md 5.7, 6.7).
#include <gtest/gtest.h>

#include <functional>

#include "tests/dem/engine/scene.h"

namespace venato::dem {
namespace {
using namespace scene;

std::uint64_t hash_after(int n, int steps, const std::function<void(SimulationSetup&)>& change, double ratio = 3) {
  SimulationSetup s = setup(4e-6);
  change(s);
  Simulation sim = heap(n, s, ratio);
  sim.step(steps);
  return sim.state_hash();
}

TEST(Determinism, ThreadsDoNotChangeAByte) {
  Simulation one = heap(700, setup(4e-6));
  one.step(2500);
  EXPECT_GT(one.statistics().list_builds, 20);  // the comparison means something only with rebuilds and contacts
  EXPECT_GT(one.statistics().contact_count, 100);
  for (const int threads : {2, 3, 4, 8})
    EXPECT_EQ(hash_after(700, 2500, [&](SimulationSetup& s) { s.threads = threads; }), one.state_hash()) << threads;
}
TEST(Determinism, GridEqualsBruteForce) {
  for (const double ratio : {1.0, 3.0, 8.0}) {
    const std::uint64_t grid = hash_after(
        300, 1500, [](SimulationSetup&) {}, ratio);
    EXPECT_EQ(hash_after(
                  300, 1500, [](SimulationSetup& s) { s.brute_force_neighbours = true; }, ratio),
              grid)
        << ratio;
  }
}
TEST(Determinism, CarriedListEqualsRebuildEveryStep) {
  const std::uint64_t carried = hash_after(300, 1200, [](SimulationSetup&) {});
  // A skin of 1e-12 m is used up by every step.
  EXPECT_EQ(hash_after(300, 1200, [](SimulationSetup& s) { s.skin_m = 1e-12; }), carried);
  EXPECT_EQ(hash_after(300, 1200, [](SimulationSetup& s) { s.skin_m = 3e-4; }), carried);
  // Negative control: another time step is another trajectory.
  EXPECT_NE(hash_after(300, 1200, [](SimulationSetup& s) { s.time_step_s *= 1.0000001; }), carried);
}
/// Loads on walls are sums over grains in the order of the list; they are added exactly, so they do not depend on it either.
TEST(Determinism, WallLoadsDoNotDependOnTheList) {
  auto impulse = [](double skin_m) {
    SimulationSetup s = setup(4e-6);
    s.skin_m = skin_m;
    Simulation sim = heap(300, s);
    sim.step(1200);
    return sim.wall_impulse_n_s(0);
  };
  const Vec3 carried = impulse(0);
  EXPECT_NE(carried.z(), 0);
  EXPECT_EQ(impulse(1e-12), carried);
  EXPECT_EQ(impulse(3e-4), carried);
}
TEST(Determinism, SavedAndLoadedGoesOnBitForBit) {
  for (const LawKind law : {LawKind::hertz_mindlin_epsd, LawKind::eepa}) {
    SimulationSetup s = setup(4e-6);
    s.law = law;
    Simulation whole = heap(300, s);
    whole.step(1003);
    const std::vector<std::uint8_t> saved = whole.save_state();
    whole.step(700);
    Simulation resumed = heap(300, s);
    resumed.load_state(saved);
    resumed.step(700);
    EXPECT_EQ(resumed.state_hash(), whole.state_hash());
    EXPECT_EQ(resumed.wall_impulse_n_s(0), whole.wall_impulse_n_s(0));
    EXPECT_EQ(resumed.statistics().list_builds, whole.statistics().list_builds);
  }
}
TEST(Determinism, TruncatedStateIsRefused) {
  Simulation sim = heap(30, setup(4e-6));
  sim.step(10);
  std::vector<std::uint8_t> saved = sim.save_state();
  saved.resize(saved.size() / 2);
  Simulation other = heap(30, setup(4e-6));
  EXPECT_THROW(other.load_state(saved), std::runtime_error);
}

/// A colliding, spinning pair through a face of the box is bit for bit the pair in the middle: positions are multiples of one quantum.
TEST(Periodic, PairThroughTheFaceEqualsThePairInTheMiddle) {
  auto run = [](double shift) {
    SimulationSetup s = setup(2e-6);
    s.box.low = Vec3(0, 0, 0), s.box.high = Vec3(0.004, 0.003, 1);
    s.box.periodic[0] = s.box.periodic[1] = true;
    Simulation sim(s);
    // 1/1024 m steps are exact in binary, so both runs start from the same numbers up to the shift.
    sim.add_grain(grain(Vec3(1.25 / 1024 + shift, 1.0 / 1024, 0.01), 2e-4, Vec3(0.3, 0.05, 0.01), Vec3(10, 20, 30)));
    sim.add_grain(grain(Vec3(1.75 / 1024 + shift, 1.0 / 1024, 0.01), 2.5e-4, Vec3(-0.2, -0.03, 0), Vec3(-3, 5, 7)));
    sim.step(3000);
    EXPECT_EQ(sim.has_grain(0), true);
    return sim.grains();
  };
  const double shift = 2.5 / 1024;  // 1.5 + 2.5 = 4 / 1024 m = 3.906 mm: they meet across x = 4 mm
  const auto middle = run(0), face = run(shift);
  bool spun = false;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(middle[k].velocity_m_s, face[k].velocity_m_s);
    EXPECT_EQ(middle[k].spin_rad_s, face[k].spin_rad_s);
    EXPECT_EQ(Vec3(middle[k].position_m + Vec3(shift, 0, 0)), face[k].position_m);
    spun = spun || std::abs(middle[k].spin_rad_s.x() - (k == 0 ? 10 : -3)) > 1e-3;
  }
  EXPECT_TRUE(spun);  // they did touch
}
TEST(Periodic, BoxOfLessThanTwoCutoffsIsRefused) {
  SimulationSetup s = setup(1e-6);
  s.box.high = Vec3(0.0016, 1, 1);
  s.box.periodic[0] = true;
  Simulation sim(s);
  sim.add_grain(grain(Vec3(1e-4, 0, 0), 4e-4));
  try {
    sim.step();
    FAIL() << "accepted";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("periodic length along x"), std::string::npos) << e.what();
  }
}
}  // namespace
}  // namespace venato::dem
