#pragma once
#include "graphics/raster/raster.h"
#include "sync/transform/transform.h"
namespace venato::line {
/// Part of a picture that the slab covers, resampled to `pitch_out_m` = the picture's own pitch times a scale. Content is moved by `placement` (print
/// frame of the output). Bilinear; positions on whole pixels are copied exactly; what lies outside the picture takes the value of its border.
/// \param channels  of the output: the source's own, or 3 of a grey one
graphics::Raster8 cut_to_slab(const graphics::Raster8& source, double source_pitch_m, double origin_x_m, double origin_y_m, double width_m,
                              double height_m, double out_from_source, const sync::Transform& placement, int channels);
}  // namespace venato::line
