#pragma once
#include "sync/mask/ink_rows.h"
namespace venato::sync {
/// print.tif, the ink files, powders at print resolution and the preview, in one pass over the strips: each thread warps a strip and compresses it for
/// every file while it is in its cache; the compressed strips are written in order. Adds the files (with sizes and SHA-256) and the times to `set`.
/// \param print_info of print.tif; rows_per_strip holds for all files. \throws WorkError, Interrupted
void write_print_files(const MaskJob& job, const PreparedLayers& layers, const WarpGrid& grid, const graphics::TiffInfo& print_info,
                       const std::filesystem::path& folder, MaskSet& set, Context& context);
}  // namespace venato::sync
