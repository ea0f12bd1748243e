#include "sync/mask/preview.h"

#include <algorithm>

namespace venato::sync {

PreviewBuilder::PreviewBuilder(std::int64_t width, std::int64_t height, double pitch_m, int channels)
    : width_(width), height_(height), channels_(channels) {
  box_ = static_cast<int>(std::max((height + kMaxHeight - 1) / kMaxHeight, (width + kMaxWidth - 1) / kMaxWidth));
  step_ = (box_ + 3) / 4;
  amounts_ = graphics::Raster8(static_cast<int>((width + box_ - 1) / box_), static_cast<int>((height + box_ - 1) / box_), channels, pitch_m * box_);
  sum_.assign(static_cast<std::size_t>(amounts_.width) * static_cast<std::size_t>(channels), 0);
  count_.assign(static_cast<std::size_t>(amounts_.width), 0);
}

void PreviewBuilder::add_rows(std::span<const std::uint8_t> rows) {
  const auto row_bytes = static_cast<std::size_t>(width_ * channels_);
  for (std::size_t start = 0; start < rows.size(); start += row_bytes, ++row_) {
    if ((row_ % box_) % step_ == 0) {
      for (int i = 0; i < amounts_.width; ++i) {
        const std::int64_t end = std::min(width_, static_cast<std::int64_t>(i + 1) * box_);
        for (std::int64_t x = static_cast<std::int64_t>(i) * box_; x < end; x += step_) {
          const std::uint8_t* pixel = rows.data() + start + static_cast<std::size_t>(x * channels_);
          for (int c = 0; c < channels_; ++c) sum_[static_cast<std::size_t>(i * channels_ + c)] += pixel[c];
          ++count_[static_cast<std::size_t>(i)];
        }
      }
    }
    if (row_ % box_ == box_ - 1 || row_ == height_ - 1) finish_row();
  }
}

void PreviewBuilder::finish_row() {
  const int j = static_cast<int>(row_ / box_);
  for (int i = 0; i < amounts_.width; ++i) {
    const std::uint32_t n = count_[static_cast<std::size_t>(i)];
    for (int c = 0; c < channels_; ++c)
      amounts_.at(i, j, c) = static_cast<std::uint8_t>((sum_[static_cast<std::size_t>(i * channels_ + c)] + n / 2) / n);
  }
  std::fill(sum_.begin(), sum_.end(), 0);
  std::fill(count_.begin(), count_.end(), 0);
}

graphics::Raster8 PreviewBuilder::picture(const std::vector<graphics::Ink>& inks, std::array<std::uint8_t, 3> body_srgb) const {
  VENATO_EXPECTS(row_ == height_);
  graphics::Raster8 out(amounts_.width, amounts_.height, 3, amounts_.pitch_m);
  for (int j = 0; j < out.height; ++j)
    for (int i = 0; i < out.width; ++i) {
      const auto rgb = graphics::predict_srgb(inks, body_srgb, amounts_.data.data() + amounts_.index(i, j));
      std::copy(rgb.begin(), rgb.end(), out.data.begin() + static_cast<std::ptrdiff_t>(out.index(i, j)));
    }
  return out;
}

}  // namespace venato::sync
