#include "sync/mask/print_size.h"

#include <algorithm>
#include <numeric>

#include "sync/mask/file_of_set.h"

namespace venato::sync {
namespace {
constexpr std::int64_t kOneStripIn = 50, kFewestStrips = 4;
}

double predict_print_bytes(const MaskJob& job, const PreparedLayers& layers, const WarpGrid& grid, const graphics::TiffInfo& info, int threads) {
  const auto row_bytes = static_cast<std::size_t>(grid.width) * job.inks.size();
  const double raw_bytes = static_cast<double>(row_bytes) * static_cast<double>(grid.height);
  if (info.compression == graphics::TiffCompression::none) return raw_bytes;
  const std::int64_t per_strip = info.rows_per_strip, strips = (grid.height + per_strip - 1) / per_strip;
  const std::int64_t samples = std::min(strips, std::max(kFewestStrips, strips / kOneStripIn));
  // The last strip may be short: leave it out unless it is the only one.
  const std::int64_t whole = std::max<std::int64_t>(1, grid.height / per_strip);
  const std::int64_t taken = std::min(samples, whole);
  const std::int64_t rows_each = std::min(per_strip, grid.height);
  std::vector<double> bytes(static_cast<std::size_t>(taken));
  for_each_parallel(static_cast<int>(taken), threads, [&](int k) {
    const std::int64_t strip = (2 * k + 1) * whole / (2 * taken);
    std::vector<std::uint8_t> rows(row_bytes * static_cast<std::size_t>(rows_each)), scratch;
    ink_rows(layers, grid, strip * per_strip, static_cast<int>(rows_each), rows, scratch, 1);
    bytes[static_cast<std::size_t>(k)] = static_cast<double>(graphics::StripCoder().encode(info, rows).size());
  });
  return std::accumulate(bytes.begin(), bytes.end(), 0.0) * static_cast<double>(grid.height) / static_cast<double>(taken * rows_each);
}

}  // namespace venato::sync
