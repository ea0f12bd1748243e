#include "line/commands/deposit_head.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace venato::line {
namespace {

FeedHead head() {
  FeedHead h;
  h.name = "vein_grey";
  h.powder = "grey";
  h.prongs = 4;
  h.ticks = 10;
  h.prong_pitch_m = 0.005;
  h.tick_s = 0.03;
  h.belt_speed_m_s = 0.1;  // 3 mm per tick: not a multiple of the 2 mm grid
  h.full_rate_kg_m2 = 25;
  h.duty.assign(40, 0.0);
  return h;
}
Bed bed() { return make_bed({10, 15, 5, 0.002, 0.0}, {"white", "grey"}); }

TEST(DepositHead, KeepsTheMassOfTheCommandsAndSpreadsItEvenlyOverTheLayers) {
  FeedHead h = head();
  for (std::size_t k = 0; k < h.duty.size(); ++k) h.duty[k] = 0.1 * static_cast<double>(k % 11);
  Bed b = bed();
  deposit_head(h, b);
  EXPECT_NEAR(b.powder_mass_kg(1), h.mass_kg(), 1e-12 * h.mass_kg());  // sums of a few hundred doubles
  EXPECT_EQ(b.powder_mass_kg(0), 0.0);
  for (std::size_t i = 0; i < b.grid.columns(); ++i) EXPECT_EQ(b.mass[1][i], b.mass[1][4 * b.grid.columns() + i]);
}

TEST(DepositHead, PlacesACellByOverlapArea) {
  FeedHead h = head();
  h.duty[1 * 4 + 2] = 1;  // x in [10, 15) mm, y in [3, 6) mm
  Bed b = bed();
  deposit_head(h, b);
  const std::vector<double> areal = b.areal_mass();
  auto at = [&](int x, int y) { return areal[static_cast<std::size_t>(y) * 10 + static_cast<std::size_t>(x)]; };
  EXPECT_NEAR(at(5, 2), 25.0, 1e-9);  // y in [4, 6): inside
  EXPECT_NEAR(at(5, 1), 12.5, 1e-9);  // y in [2, 4): half
  EXPECT_NEAR(at(7, 2), 12.5, 1e-9);  // x in [14, 16): half
  EXPECT_NEAR(at(4, 2), 0.0, 0.0);
  EXPECT_NEAR(at(5, 3), 0.0, 1e-9);
}

TEST(DepositHead, RefusesAPowderTheLineDoesNotHave) {
  FeedHead h = head();
  h.powder = "red";
  Bed b = bed();
  EXPECT_THROW(deposit_head(h, b), UsageError);
}
}  // namespace
}  // namespace venato::line
