#pragma once
#include "sync/mask/ink_rows.h"
namespace venato::sync {
/// Size of print.tif [bytes], predicted by writing every fiftieth strip (at least four) to `scratch_file`, which is removed.
/// Exact without compression.
double predict_print_bytes(const MaskJob& job, const PreparedLayers& layers, const WarpGrid& grid, const graphics::TiffInfo& info,
                           const std::filesystem::path& scratch_file, int threads);
}  // namespace venato::sync
