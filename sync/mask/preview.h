#pragma once
#include <array>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>
#include "graphics/graphic.h"
#include "graphics/raster/raster.h"
namespace venato::sync {

/// Makes the small sRGB preview while the print's strips pass by: the mean ink amounts of a k x k box become one pixel.
class PreviewBuilder {
 public:
  static constexpr int kMaxHeight = 1600, kMaxWidth = 4000;
  PreviewBuilder(std::int64_t width, std::int64_t height, double pitch_m, int channels);
  /// Rows from `first_row` on, interleaved, 0 = no ink. Any order, any thread: sums of whole numbers do not depend on it. Each row once.
  void add_rows(std::int64_t first_row, std::span<const std::uint8_t> rows);
  /// \pre all rows were added
  /// \return mean ink amounts of each box
  graphics::Raster8 amounts() const;

 private:
  std::int64_t width_, height_, rows_added_ = 0;
  double pitch_m_;
  int channels_, box_, step_;  ///< step_: every how many pixels of a box one is taken, both ways; 4 x 4 samples of contone data are its mean
  int out_width_, out_height_;
  std::vector<std::uint16_t> sum_;  ///< [box row][box][channel]; at most 4 x 4 x 255
  std::mutex guard_;
  /// How many samples a box has along one axis.
  int samples(int box, std::int64_t side) const;
};
}  // namespace venato::sync
