#include "sync/mask/powder_rows.h"

#include <gtest/gtest.h>

#include <cmath>

namespace venato::sync {
namespace {

std::vector<std::uint8_t> coverage(const PowderMask& powder, const WarpGrid& grid, int threads = 1) {
  std::vector<std::uint8_t> out(static_cast<std::size_t>(grid.width * grid.height));
  powder_rows(powder, grid, 0, static_cast<int>(grid.height), out, threads);
  return out;
}

TEST(PowderRows, FractionsAtTheirOwnPitchAreOnlyRounded) {
  PowderMask powder;
  powder.fraction = graphics::RasterF(5, 1, 1, 0.001);
  powder.fraction.data = {0.0f, 0.25f, 0.5f, 1.0f, std::nanf("")};
  EXPECT_EQ(coverage(powder, own_grid(powder)), (std::vector<std::uint8_t>{0, 64, 128, 255, 0}));
}

TEST(PowderRows, SignedDistanceGivesAStraightEdgeOfTheAskedWidthAtAnyResolution) {
  // Vein left of x = 10.3 mm on a 1 mm raster; spread 0.3 mm moves the edge to 10.6 mm, feather 0.8 mm.
  PowderMask powder;
  powder.spread_m = 0.0003;
  powder.feather_m = 0.0008;
  powder.signed_distance_m = graphics::RasterF(20, 8, 1, 0.001);
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 20; ++i) powder.signed_distance_m.at(i, j) = static_cast<float>(0.0103 - (i + 0.5) * 0.001);
  const double pitch = 0.0254 / 600;
  const WarpGrid grid{472, 100, pitch};
  const auto got = coverage(powder, grid, 2);
  for (int i = 20; i < 450; ++i) {
    const double want = std::clamp(0.5 + (0.0106 - (i + 0.5) * pitch) / 0.0008, 0.0, 1.0) * 255;
    EXPECT_NEAR(got[static_cast<std::size_t>(50 * 472 + i)], want, 0.51) << i;  // one rounding, float arithmetic
  }
  EXPECT_EQ(got, coverage(powder, grid, 1));
}

}  // namespace
}  // namespace venato::sync
