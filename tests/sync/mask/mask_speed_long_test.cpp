// All files of a 600 x 1200 mm slab (9142 x 18284 px at 360 dpi with its green surplus), 6 inks: seconds and memory.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>

#include "base/units.h"
#include "sync/mask/mask_job.h"
#include "tests/sync/mask/mask_fixture.h"

namespace venato::sync {
namespace {

TEST(MaskSpeed, WholeSlab) {
  test::TestContext t;
  test::TempFolder out;
  MaskJob job = test::small_job();
  job.width_m = 9142 * kMetresPerInch / 360;
  job.height_m = 18284 * kMetresPerInch / 360;
  job.layers[0].ink = test::bands(1700, 3400, 6, 0.0004);
  Rng rng(5, stream_id("test/mask/grain"));  // grain of +-3 levels, so that compression has something to do
  for (auto& v : job.layers[0].ink.data) v = static_cast<std::uint8_t>(v + static_cast<int>(rng.below(7)) - 3);
  job.print_from_green = test::bent(job.width_m, job.height_m, 0.048, 0.004);
  rusage before{};
  getrusage(RUSAGE_SELF, &before);
  const auto start = std::chrono::steady_clock::now();
  const MaskSet set = write_masks(job, out.path / "masks", t.context);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  rusage after{};
  getrusage(RUSAGE_SELF, &after);
  const auto cpu = [](const rusage& u) {
    return static_cast<double>(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * static_cast<double>(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
  };
  ASSERT_EQ(set.width_px, 9142);
  ASSERT_EQ(set.height_px, 18284);
  std::uintmax_t bytes = 0, print_bytes = 0;
  for (const auto& file : set.files) {
    bytes += file.bytes;
    if (file.name == "print.tif") print_bytes = file.bytes;
  }
  std::printf(
      "9142 x 18284 x 6: %.1f s wall, %.1f cpu-s, %d threads, %.0f MB written, print.tif predicted %.1f MB got %.1f MB, peak memory %.0f MB\n", wall,
      cpu(after) - cpu(before), t.context.threads, static_cast<double>(bytes) / 1e6, set.predicted_print_bytes / 1e6,
      static_cast<double>(print_bytes) / 1e6, static_cast<double>(after.ru_maxrss) / 1e3);
  EXPECT_NEAR(set.predicted_print_bytes / static_cast<double>(print_bytes), 1, 0.1);  // 2 % of the strips of an even picture
  EXPECT_LT(after.ru_maxrss, 500000) << "kB: 35 MB of source, strips and compression buffers of 2 threads; the print itself is 1003 MB";
}

}  // namespace
}  // namespace venato::sync
