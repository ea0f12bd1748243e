// Rate of the warp beside OpenCV's 4-channel remap in the same run, one thread each.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "sync/warp/warp.h"
#include "tests/sync/warp/warp_fixture.h"

namespace venato::sync {
namespace {

double seconds_of(const auto& work) {
  double best = 1e9;
  for (int k = 0; k < 3; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

TEST(WarpSpeed, KeepsUpWithRemap) {
  const WarpGrid grid{8192, 2048, 0.0254 / 360};
  const Transform map = test::bent(0.578, 0.1445, 0.048, 0.004);
  const double mpx = static_cast<double>(grid.width * grid.height) / 1e6;
  double rate6 = 0;
  for (const int channels : {1, 4, 5, 6, 8}) {
    const graphics::Raster8 source = test::noise(8400, 2300, channels, grid.pitch_m);
    std::vector<std::uint8_t> out(static_cast<std::size_t>(grid.width * 64 * channels));
    const double s = seconds_of([&] {
      for (int row = 0; row < grid.height; row += 64) warp_rows(source, map, grid, row, 64, out, 1);
    });
    std::printf("warp %d ch: %.1f Mpx/s per core\n", channels, mpx / s);
    if (channels == 6) rate6 = mpx / s;
  }
  cv::setNumThreads(1);
  const graphics::Raster8 source = test::noise(8400, 2300, 4, grid.pitch_m);
  const cv::Mat input(source.height, source.width, CV_8UC4, const_cast<std::uint8_t*>(source.data.data()));
  cv::Mat mx(static_cast<int>(grid.height), static_cast<int>(grid.width), CV_32F), my = mx.clone(), out;
  for (int j = 0; j < grid.height; ++j) {
    const RowPositions p = source_positions(map, source.pitch_m, grid, j);
    for (int i = 0; i < grid.width; ++i) {
      mx.at<float>(j, i) = static_cast<float>(p.x[static_cast<std::size_t>(i)]);
      my.at<float>(j, i) = static_cast<float>(p.y[static_cast<std::size_t>(i)]);
    }
  }
  const double remap4 = mpx / seconds_of([&] { cv::remap(input, out, mx, my, cv::INTER_LINEAR, cv::BORDER_CONSTANT); });
  std::printf("cv::remap 4 ch (ready-made float maps): %.1f Mpx/s per core\n", remap4);
  // Not a race: a factor of 3 below the target of 0.8 would mean that the vector path is not taken at all. Machines are shared.
  EXPECT_GT(rate6, 0.27 * remap4);
}

}  // namespace
}  // namespace venato::sync
