#include "sync/mask/ink_rows.h"

#include <algorithm>

namespace venato::sync {

PreparedLayers prepare_layers(const MaskJob& job, const WarpGrid& grid) {
  PreparedLayers out;
  for (const InkLayer& layer : job.layers) {
    const graphics::Raster8* source = &layer.ink;
    if (graphics::Raster8 reduced = reduced_if_finer(layer.ink, grid.pitch_m); !reduced.empty()) {
      out.reduced.push_back(std::move(reduced));
      source = &out.reduced.back();
    }
    out.layers.push_back({source, layer.warp ? &job.print_from_green : &job.pose_from_green});
  }
  return out;
}

void ink_rows(const PreparedLayers& layers, const WarpGrid& grid, std::int64_t first_row, int rows, std::span<std::uint8_t> out,
              std::vector<std::uint8_t>& scratch, int threads) {
  bool first = true;
  for (const PreparedLayers::Layer& layer : layers.layers) {
    if (first) {
      warp_rows(*layer.source, *layer.source_from_green, grid, first_row, rows, out, threads);
      first = false;
      continue;
    }
    scratch.resize(out.size());
    warp_rows(*layer.source, *layer.source_from_green, grid, first_row, rows, scratch, threads);
    const auto n = static_cast<std::ptrdiff_t>(out.size());
#pragma omp parallel for num_threads(threads) if (threads > 1)
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      out[i] = static_cast<std::uint8_t>(std::min(255, out[i] + scratch[i]));
    }
  }
}

void take_ink(std::span<const std::uint8_t> interleaved, int channels, int channel, Polarity polarity, std::span<std::uint8_t> out) {
  const std::uint8_t flip = polarity == Polarity::zero_is_full_ink ? 255 : 0;
  const std::uint8_t* from = interleaved.data() + channel;
  for (std::size_t k = 0; k < out.size(); ++k, from += channels) out[k] = static_cast<std::uint8_t>(*from ^ flip);
}

}  // namespace venato::sync
