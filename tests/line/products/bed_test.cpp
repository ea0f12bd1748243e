#include "line/products/bed.h"

#include <gtest/gtest.h>

#include "line/products/feed_commands.h"

using namespace venato::line;

// 0.5 kg/m2 in one cell of each of two layers, 2 mm pitch: 2 * 0.5 * 4e-6 kg. Exact in binary up to rounding of the pitch.
TEST(Bed, MassesAndArealMass) {
  Bed bed = make_bed({3, 2, 2, 2e-3, 0}, {"body", "vein"});
  EXPECT_EQ(bed.total_mass_kg(), 0);
  bed.mass[1][4] = 0.5;
  bed.mass[1][6 + 4] = 0.5;
  bed.mass[0][0] = 3;
  EXPECT_NEAR(bed.powder_mass_kg(1), 4e-6, 1e-20);
  EXPECT_NEAR(bed.total_mass_kg(), 16e-6, 1e-20);
  EXPECT_EQ(bed.areal_mass(), (std::vector<double>{3, 0, 0, 0, 1, 0}));
}

TEST(FeedHead, MassIsDutyTimesRateTimesArea) {
  FeedHead head{"h", "vein", 2, 3, 5e-3, 0.01, 0.1, 12.0, {1, 0, 0.5, 0, 0, 1}};
  EXPECT_NEAR(head.mass_kg(), 2.5 * 12 * 5e-3 * 1e-3, 1e-18);
}
