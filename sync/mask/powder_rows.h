#pragma once
#include <cstdint>
#include <span>
#include "sync/mask/mask_job.h"
#include "sync/warp/warp.h"
namespace venato::sync {

/// Coverage of a powder, 0 = none, 255 = full, on rows of any grid of the green frame: the raster is interpolated bilinearly (clamped at its border),
/// then a fraction is rounded, or a signed distance becomes clamp(1/2 + (distance + spread) / feather): smooth edges at any resolution.
void powder_rows(const PowderMask& powder, const WarpGrid& grid, std::int64_t first_row, int rows, std::span<std::uint8_t> out, int threads);
/// The raster's own grid.
WarpGrid own_grid(const PowderMask& powder);
}  // namespace venato::sync
