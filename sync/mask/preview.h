#pragma once
#include <array>
#include <cstdint>
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
  /// Rows in order, interleaved, 0 = no ink.
  void add_rows(std::span<const std::uint8_t> rows);
  /// \pre all rows were added
  graphics::Raster8 picture(const std::vector<graphics::Ink>& inks, std::array<std::uint8_t, 3> body_srgb) const;

 private:
  std::int64_t width_, height_, row_ = 0;
  int channels_, box_, step_;  ///< step_: every how many pixels of a box one is taken, both ways; 4 x 4 samples of contone data are its mean
  graphics::Raster8 amounts_;
  std::vector<std::uint32_t> sum_;
  std::vector<std::uint32_t> count_;
  void finish_row();
};
}  // namespace venato::sync
