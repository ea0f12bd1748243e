#pragma once
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cstdio>
#include <string>
#include <vector>

#include "graphics/rectify/homography.h"
#include "graphics/rectify/rectify.h"
#include "tests/graphics/support.h"
namespace venato::graphics::test {

/// A pinhole camera over a 400 x 600 mm slab, tilted about both axes and turned: homography from intrinsics and pose, not from marks.
/// \param tilt_deg 0: looks straight down
struct Pinhole {
  Lens lens{2600, 2600, 699.5, 874.5, -0.08, 0.02, 0, 3e-4, -2e-4};
  int width_px = 1400, height_px = 1750;
  Eigen::Matrix3d ideal_px_from_slab_m;
  explicit Pinhole(double tilt_deg = 8) {
    const double tilt = tilt_deg * M_PI / 180;
    const Eigen::Matrix3d r = (Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(-tilt / 2, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()))
                                  .toRotationMatrix();
    Eigen::Matrix3d k, place;
    k << lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1;
    place.col(0) = r.col(0);
    place.col(1) = r.col(1);
    place.col(2) = r * Eigen::Vector3d(-0.20, -0.30, 0) + Eigen::Vector3d(0, 0, 1.05);  // its middle on the axis, 1.05 m away: 0.4 mm/px
    ideal_px_from_slab_m = k * place;
  }
  Eigen::Vector2d picture_px(const Eigen::Vector2d& slab_m) const { return distorted(lens, project(ideal_px_from_slab_m, slab_m)); }
  bool slab_m(const Eigen::Vector2d& picture_px, Eigen::Vector2d& slab) const {
    Eigen::Vector2d ideal;
    if (!undistorted(lens, picture_px, ideal)) return false;
    slab = project(ideal_px_from_slab_m.inverse(), ideal);
    return true;
  }
  CameraView view(const std::vector<Eigen::Vector2d>& marks_m = {{0, 0}, {0.4, 0}, {0.4, 0.6}, {0, 0.6}}) const {
    CameraView v;
    v.file = "camera.json";
    v.width_m = 0.4, v.height_m = 0.6, v.pitch_m = 0.0005, v.mark_limit_m = 0.0005;
    v.lens = lens;
    for (const auto& m : marks_m) v.marks.push_back({picture_px(m), m});
    return v;
  }
};
inline std::string num(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", v);
  return text;
}
inline std::string camera_json(const CameraView& v) {
  std::string out = "{\"format\":\"venato-camera\",\"version\":1,\"slab_mm\":[" + num(v.width_m * 1e3) + "," + num(v.height_m * 1e3) +
                    "],\"pitch_mm\":" + num(v.pitch_m * 1e3) + ",\"marks\":[";
  for (std::size_t k = 0; k < v.marks.size(); ++k)
    out += std::string(k ? "," : "") + "{\"px\":[" + num(v.marks[k].picture_px.x()) + "," + num(v.marks[k].picture_px.y()) + "],\"mm\":[" +
           num(v.marks[k].slab_m.x() * 1e3) + "," + num(v.marks[k].slab_m.y() * 1e3) + "]}";
  out += "]";
  if (v.lens) {
    const Lens& l = *v.lens;
    out += ",\"lens\":{\"fx_px\":" + num(l.fx_px) + ",\"fy_px\":" + num(l.fy_px) + ",\"cx_px\":" + num(l.cx_px) + ",\"cy_px\":" + num(l.cy_px) +
           ",\"k1\":" + num(l.k1) + ",\"k2\":" + num(l.k2) + ",\"p1\":" + num(l.p1) + ",\"p2\":" + num(l.p2) + ",\"k3\":" + num(l.k3) + "}";
  }
  return out + "}";
}
}  // namespace venato::graphics::test
