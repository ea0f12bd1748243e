#pragma once
#include "sync/mask/ink_rows.h"
namespace venato::sync {
/// Size of print.tif [bytes], predicted by compressing every fiftieth strip (at least four). Exact without compression.
double predict_print_bytes(const MaskJob& job, const PreparedLayers& layers, const WarpGrid& grid, const graphics::TiffInfo& info, int threads);
}  // namespace venato::sync
