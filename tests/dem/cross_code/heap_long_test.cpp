// Case A: a cylinder of 10,000 grains is lifted; flank angle and profile of the heap against LIGGGHTS-PUBLIC 3.8.0 (one run each; sd over six wedges
// of 60 degrees of the same heap). The heap is 8 diameters high: numbers for this set-up, not material angles.
#include <gtest/gtest.h>

#include "tests/dem/cross_code/heap_profile.h"
#include "tests/dem/cross_code/peers.h"

namespace venato::dem::peers {
namespace {
struct Peer {
  double rolling_friction, flank_deg, sd_deg, apex_mm;
  double height_mm[6];  ///< surface at r = 4.5, 8.5, 12.5, 16.5, 20.5, 24.5 mm
};
constexpr Peer kPeers[] = {{0.05, 12.68, 0.39, 6.47, {6.4732, 6.1032, 5.1734, 4.3440, 3.4675, 2.6648}},
                           {0.1, 15.72, 0.45, 8.07, {8.0739, 6.9686, 5.8276, 4.6762, 3.6401, 2.4390}},
                           {0.2, 20.45, 0.90, 8.73, {8.7256, 7.8949, 6.5290, 5.1120, 3.6877, 1.9602}}};

class PeerHeap : public testing::TestWithParam<Peer> {};
/// `law_deg`: part of the angle by which the laws themselves may differ.
void expect_like_liggghts(const Peer& peer, LawKind law, double law_deg) {
  Heap h;
  h.law = law;
  h.rolling_friction = peer.rolling_friction, h.threads = 2;
  const auto grains = run_heap(h);
  ASSERT_EQ(grains.size(), 10000u);
  const HeapProfile p = heap_profile(grains);
  testing::Test::RecordProperty("flank_deg", std::to_string(p.flank_deg) + " sd " + std::to_string(p.flank_sd_deg));
  testing::Test::RecordProperty("apex_mm", std::to_string(1e3 * p.apex_m));
  testing::Test::RecordProperty("mean_speed_m_s", std::to_string(p.mean_speed_m_s));
  EXPECT_LT(p.mean_speed_m_s, 1e-3);  // at rest
  // Each heap's angle is known to about sd / sqrt(6) from its wedges; both heaps, three sigma.
  const double sd = std::max(peer.sd_deg, p.flank_sd_deg);
  EXPECT_NEAR(p.flank_deg, peer.flank_deg, 3 * std::sqrt(2.0) * sd / std::sqrt(6.0) + law_deg);
  // Surface: half a diameter, the roughness of the highest grains of 36 sectors being a tenth of one and the apex of one heap a third.
  for (int k = 0; k < 6; ++k) {
    const double ours = 1e3 * p.height_m[static_cast<std::size_t>(4 + 4 * k)];
    testing::Test::RecordProperty("height_mm_" + std::to_string(k), std::to_string(ours) + " " + std::to_string(peer.height_mm[k]));
    EXPECT_NEAR(ours, peer.height_mm[k], 0.5) << "r = " << 4.5 + 4 * k << " mm";
  }
}
TEST_P(PeerHeap, comparison_law_has_the_flank_of_liggghts) { expect_like_liggghts(GetParam(), LawKind::liggghts_hertz, 0); }
/// Half a degree for the laws: theirs lets tangential damping exceed Coulomb's limit and does not turn its rolling history with the contact.
TEST_P(PeerHeap, our_law_has_the_flank_of_liggghts) { expect_like_liggghts(GetParam(), LawKind::hertz_mindlin_epsd, 0.5); }
INSTANTIATE_TEST_SUITE_P(RollingFriction, PeerHeap, testing::ValuesIn(kPeers));
}  // namespace
}  // namespace venato::dem::peers
