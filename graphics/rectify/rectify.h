#pragma once
#include "graphics/raster/raster.h"
#include "graphics/rectify/camera.h"
namespace venato::graphics {

/// A camera's picture brought into the slab's frame.
struct Rectified {
  Raster8 picture;  ///< channels as the camera's; 0 where not valid
  Raster8 valid;    ///< 255 where the camera saw the slab (and the margin leaves it)
  SolvedView view;
  double visible = 0;  ///< 0..1 share of the slab that is valid
};
/// Each pixel is the mean of n x n bilinear samples spread over it, n as many as camera pixels lie across one at the finest place: area averaging, so
/// that grain does not alias. Values are averaged as stored (as shrink() does). Own sampler: cv::remap rounds places to 1/32 px and ends at 32766 px.
/// \throws UsageError naming the camera file: solve_view()'s reasons; less than a tenth of the slab in the picture; more than 16 camera pixels across
/// one pixel. Same bytes for any number of threads.
Rectified rectify(const Raster8& camera, const CameraView& view, int threads);
}  // namespace venato::graphics
