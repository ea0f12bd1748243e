#pragma once
#include <deque>
#include <span>
#include <vector>
#include "sync/mask/mask_job.h"
#include "sync/warp/warp.h"
namespace venato::sync {

/// The layers of a job, ready to be sampled at the print's pitch (averaged first where they are finer).
struct PreparedLayers {
  struct Layer {
    const graphics::Raster8* source = nullptr;
    const Transform* source_from_green = nullptr;
  };
  std::vector<Layer> layers;
  std::deque<graphics::Raster8> reduced;  ///< owns what had to be averaged; a deque keeps addresses
};
PreparedLayers prepare_layers(const MaskJob& job, const WarpGrid& grid);

/// Rows [first_row, first_row + rows) of all inks, interleaved, 0 = no ink. Layers add up and stop at full ink.
/// \param scratch  grown as needed, kept by the caller between calls
void ink_rows(const PreparedLayers& layers, const WarpGrid& grid, std::int64_t first_row, int rows, std::span<std::uint8_t> out,
              std::vector<std::uint8_t>& scratch, int threads);

/// One ink of interleaved rows; inverted for zero_is_full_ink.
void take_ink(std::span<const std::uint8_t> interleaved, int channels, int channel, Polarity polarity, std::span<std::uint8_t> out);
}  // namespace venato::sync
