#pragma once
#include "sync/mask/mask_job.h"
namespace venato::sync {
/// \throws UsageError naming what is wrong with a job: sizes, dpi, names, channel counts, rasters, screened input.
void check_job(const MaskJob& job);
}  // namespace venato::sync
