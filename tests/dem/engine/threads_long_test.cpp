/// Bits do not depend on the number of threads over 10^5 steps with rebuilds: a difference in any order of summation would have grown to order one
/// long before (the motion is chaotic: times e in about a millisecond of 250 steps). 300 grains are two blocks of
/// work: threads beyond that must not make a difference either (threads_test.cpp gives eight threads work).
#include <gtest/gtest.h>

#include <vector>

#include "tests/dem/engine/stirred_scene.h"

namespace venato::dem {
namespace {
std::vector<std::uint64_t> hashes(int threads) {
  Simulation sim = scene::stirred_heap(300, threads);
  std::vector<std::uint64_t> all;
  for (int k = 0; k < 5; ++k) sim.step(20000), all.push_back(sim.state_hash());
  EXPECT_GT(sim.statistics().list_builds, 500);
  EXPECT_GT(sim.statistics().contact_count, 100);
  return all;
}
TEST(Threads, HundredThousandStepsAreTheSameBytes) {
  const std::vector<std::uint64_t> one = hashes(1);
  for (const int threads : {2, 3, 4, 8}) EXPECT_EQ(hashes(threads), one) << threads;
}
}  // namespace
}  // namespace venato::dem
