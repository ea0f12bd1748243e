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
/// `shift_deg`: how much flatter (< 0) the law itself makes the heap.
HeapProfile expect_flank_of_liggghts(const Peer& peer, LawKind law, double shift_deg) {
  Heap h;
  h.law = law;
  h.rolling_friction = peer.rolling_friction, h.threads = 2;
  const auto grains = run_heap(h);
  EXPECT_EQ(grains.size(), 10000u);
  const HeapProfile p = heap_profile(grains);
  testing::Test::RecordProperty("flank_deg", std::to_string(p.flank_deg) + " sd " + std::to_string(p.flank_sd_deg));
  testing::Test::RecordProperty("apex_mm", std::to_string(1e3 * p.apex_m));
  testing::Test::RecordProperty("mean_speed_m_s", std::to_string(p.mean_speed_m_s));
  EXPECT_LT(p.mean_speed_m_s, 1e-3);  // at rest
  // Each heap's angle is known to about sd / sqrt(6) from its wedges; both heaps, three sigma.
  const double sd = std::max(peer.sd_deg, p.flank_sd_deg);
  EXPECT_NEAR(p.flank_deg, peer.flank_deg + shift_deg, 3 * std::sqrt(2.0) * sd / std::sqrt(6.0));
  return p;
}

/// Same formulas in our engine: flank and surface of the peer. What is left to differ is the packing, the lever on walls and the half-step normal.
TEST_P(PeerHeap, comparison_law_has_the_heap_of_liggghts) {
  const Peer& peer = GetParam();
  const HeapProfile p = expect_flank_of_liggghts(peer, LawKind::liggghts_hertz, 0);
  for (int k = 0; k < 6; ++k) {
    const double ours = 1e3 * p.height_m[static_cast<std::size_t>(4 + 4 * k)];
    RecordProperty("height_mm_" + std::to_string(k), std::to_string(ours) + " " + std::to_string(peer.height_mm[k]));
    // A ring of 36 sectors is known to a tenth of a diameter, the flank of one heap wanders by a few; the apex is one or two grains.
    EXPECT_NEAR(ours, peer.height_mm[k], k == 0 ? 1.0 : 0.4) << "r = " << 4.5 + 4 * k << " mm";
  }
}
/// Our law: 3 deg flatter at all three rolling frictions (measured 9.56, 12.67, 17.67 deg against 12.68, 15.72, 20.45), because of the law and not of
/// the engine: the test above gives 15.67 for 15.72 with their formulas. Theirs adds rolling damping without a cap (28 times the limit at the first
/// touch of a rolling grain), and that is what makes the heap steeper: at mu_r = 0.1 their law with the rolling torque capped gives 12.60 +- 0.40 deg,
/// ours 12.67; with only Coulomb's limit held by the tangential damping 15.26 +- 0.55, with only the rolling torque turned into the new plane
/// 15.31 +- 0.43, with both caps 12.77 +- 0.46.
TEST_P(PeerHeap, our_law_is_three_degrees_flatter) { expect_flank_of_liggghts(GetParam(), LawKind::hertz_mindlin_epsd, -3); }
INSTANTIATE_TEST_SUITE_P(RollingFriction, PeerHeap, testing::ValuesIn(kPeers));
}  // namespace
}  // namespace venato::dem::peers
