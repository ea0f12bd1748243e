/// Bits do not depend on the number of threads (design.md 4; house style 16): enough grains that eight threads each have work (the engine shares them
/// out in blocks of 256), every kind of wall in motion. The 10^5 steps are in threads_long_test.cpp.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/dem/engine/stirred_scene.h"

namespace venato::dem {
namespace {
TEST(Threads, OneToEightGiveTheSameBytes) {
  for (const LawKind law : {LawKind::hertz_mindlin_epsd, LawKind::eepa}) {
    const int steps = law == LawKind::eepa ? 300 : 500;
    Simulation one = scene::stirred_heap(2100, 1, law);
    one.step(steps);
    EXPECT_GT(one.statistics().list_builds, 3);
    EXPECT_GT(one.statistics().contact_count, 30);
    for (const int threads : {2, 3, 4, 8}) {
      Simulation more = scene::stirred_heap(2100, threads, law);
      more.step(steps);
      EXPECT_EQ(more.state_hash(), one.state_hash()) << threads;
      EXPECT_EQ(more.save_state().size(), one.save_state().size()) << threads;
    }
  }
}
/// Negative control: the hash sees one unit in the last place of one coordinate of one grain.
TEST(Threads, TheHashSeesTheLastBit) {
  Simulation a = scene::stirred_heap(300, 1), b = scene::stirred_heap(300, 1);
  EXPECT_EQ(a.state_hash(), b.state_hash());
  const GrainState g = b.grain(17);
  b.set_velocity(17, Vec3(std::nextafter(g.velocity_m_s.x(), 10.), g.velocity_m_s.y(), g.velocity_m_s.z()), g.spin_rad_s);
  EXPECT_NE(a.state_hash(), b.state_hash());
}
}  // namespace
}  // namespace venato::dem
