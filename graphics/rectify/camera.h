#pragma once
/// How a camera saw a slab, and where a place of the slab is in its picture.
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>
#include "base/config/object_reader.h"
#include "graphics/rectify/lens.h"
namespace venato::graphics {

/// A place that is known on the slab and in the picture. Slab: metres, origin its top-left corner, x right, y down. Picture: pixels as the camera
/// took them (with the lens's distortion), the centre of the top-left pixel at (0, 0), as OpenCV counts.
struct Mark {
  Eigen::Vector2d picture_px, slab_m;
};
/// A camera file (format venato-camera): the slab's frame, and either marks or a homography.
struct CameraView {
  std::filesystem::path file;
  double width_m = 0, height_m = 0, pitch_m = 0;                       ///< the slab, and the pitch to bring the picture to
  double margin_m = 0;                                                 ///< rim of the slab that is not used
  double mark_limit_m = 0;                                             ///< largest residual of a mark; only five marks or more leave any
  std::vector<Mark> marks;                                             ///< empty: slab_m_from_ideal_px is given
  Eigen::Matrix3d slab_m_from_ideal_px = Eigen::Matrix3d::Identity();  ///< of undistorted pixels
  std::optional<Lens> lens;
};
void read_camera_keys(ObjectReader& r, CameraView& view);  ///< the declarations, for describing and reading
/// \throws UsageError (ConfigError: all mistakes at once): missing, not JSON, unknown keys, values out of range
CameraView read_camera(const std::filesystem::path& file);

inline constexpr double kMaxSlabPixels = 2.5e8;  ///< of the rectified picture, as load_picture's

/// The camera, solved for a picture of a given size.
struct SolvedView {
  Eigen::Matrix3d ideal_px_from_slab_m = Eigen::Matrix3d::Identity();
  std::optional<Lens> lens;
  double radius_limit = 0;                    ///< of the lens, in focal lengths
  int marks = 0;                              ///< 0: the homography was given
  double mark_median_m = 0, mark_max_m = 0;   ///< residuals on the slab; 0 with four marks
  double finest_m_px = 0, coarsest_m_px = 0;  ///< what one pixel of the camera covers, over the slab
  /// \return false where the lens cannot have imaged it
  bool locate(const Eigen::Vector2d& slab_m, Eigen::Vector2d& picture_px) const;
};
/// \throws UsageError naming the camera file and the reason: marks outside the picture, repeated, on a line, crossed or mirrored, residual over the
/// limit; a homography without inverse, mirrored, or with the horizon on the slab
SolvedView solve_view(const CameraView& view, int width_px, int height_px);
}  // namespace venato::graphics
