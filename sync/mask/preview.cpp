#include "sync/mask/preview.h"

#include <algorithm>

namespace venato::sync {

PreviewBuilder::PreviewBuilder(std::int64_t width, std::int64_t height, double pitch_m, int channels)
    : width_(width), height_(height), channels_(channels) {
  box_ = static_cast<int>(std::max((height + kMaxHeight - 1) / kMaxHeight, (width + kMaxWidth - 1) / kMaxWidth));
  step_ = (box_ + 3) / 4;
  pitch_m_ = pitch_m * box_;
  out_width_ = static_cast<int>((width + box_ - 1) / box_);
  out_height_ = static_cast<int>((height + box_ - 1) / box_);
  sum_.assign(static_cast<std::size_t>(out_width_) * static_cast<std::size_t>(out_height_) * static_cast<std::size_t>(channels), 0);
}

int PreviewBuilder::samples(int box, std::int64_t side) const {
  const auto covered = static_cast<int>(std::min<std::int64_t>(box_, side - static_cast<std::int64_t>(box) * box_));
  return (covered + step_ - 1) / step_;
}

void PreviewBuilder::add_rows(std::int64_t first_row, std::span<const std::uint8_t> rows) {
  const auto row_bytes = static_cast<std::size_t>(width_ * channels_), line_size = static_cast<std::size_t>(out_width_ * channels_);
  std::vector<std::uint16_t> line(line_size);
  std::int64_t row = first_row;
  for (std::size_t start = 0; start < rows.size(); start += row_bytes, ++row) {
    if ((row % box_) % step_ != 0) continue;
    std::fill(line.begin(), line.end(), std::uint16_t{0});
    for (int i = 0; i < out_width_; ++i) {
      const std::int64_t begin = static_cast<std::int64_t>(i) * box_, end = std::min(width_, begin + box_);
      std::uint16_t* to = line.data() + static_cast<std::size_t>(i * channels_);
      for (std::int64_t x = begin; x < end; x += step_) {
        const std::uint8_t* pixel = rows.data() + start + static_cast<std::size_t>(x * channels_);
        for (int c = 0; c < channels_; ++c) to[c] = static_cast<std::uint16_t>(to[c] + pixel[c]);
      }
    }
    std::uint16_t* to = sum_.data() + static_cast<std::size_t>(row / box_) * line_size;
    const std::lock_guard lock(guard_);  // a box may reach into the next strip, which another thread has
    for (std::size_t k = 0; k < line_size; ++k) to[k] = static_cast<std::uint16_t>(to[k] + line[k]);
  }
  const std::lock_guard lock(guard_);
  rows_added_ += row - first_row;
}

graphics::Raster8 PreviewBuilder::amounts() const {
  VENATO_EXPECTS(rows_added_ == height_);
  graphics::Raster8 amounts(out_width_, out_height_, channels_, pitch_m_);
  std::size_t k = 0;
  for (int j = 0; j < out_height_; ++j)
    for (int i = 0; i < out_width_; ++i) {
      const unsigned n = static_cast<unsigned>(samples(i, width_) * samples(j, height_));
      for (int c = 0; c < channels_; ++c, ++k) amounts.data[k] = static_cast<std::uint8_t>((sum_[k] + n / 2) / n);
    }
  return amounts;
}

}  // namespace venato::sync
