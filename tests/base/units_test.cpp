#include "base/units.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

namespace venato {

TEST(Units, FactorsAreExactDecimalLiterals) {
  EXPECT_EQ(si_factor("mm"), 1e-3);
  EXPECT_EQ(si_factor("um"), 1e-6);
  EXPECT_EQ(si_factor("MPa"), 1e6);
  EXPECT_EQ(si_factor("GPa"), 1e9);
  EXPECT_EQ(si_factor("g/cm3"), 1e3);
  EXPECT_EQ(si_factor("%"), 1e-2);
  EXPECT_EQ(si_factor("ms"), 1e-3);
  EXPECT_EQ(si_factor(""), 1);
  EXPECT_EQ(si_factor("dpi"), 1);
}

// One rounding in the division: a few units in the last place of the factor.
TEST(Units, DerivedFactors) {
  EXPECT_NEAR(si_factor("m/min") * 60, 1, 1e-15);
  EXPECT_NEAR(si_factor("deg") * 180, std::numbers::pi, 1e-15);
  EXPECT_NEAR(si_factor("rpm") * 60, 2 * std::numbers::pi, 1e-14);
  EXPECT_NEAR(si_factor("g/s"), 1e-3, 1e-18);
}

TEST(Units, UnknownUnitIsAProgrammerError) {
  EXPECT_THROW(si_factor("furlong"), std::logic_error);
  EXPECT_THROW(si_factor("MM"), std::logic_error);
}
}  // namespace venato
