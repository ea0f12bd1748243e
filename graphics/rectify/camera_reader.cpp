#include <cmath>

#include "graphics/rectify/camera.h"
namespace venato::graphics {
namespace {
constexpr std::size_t kMostMarks = 1000;

void read_lens(ObjectReader& r, Lens& lens) {
  const Range focal{1, 1e7, "px"}, centre{-1e6, 1e6, "px"}, coefficient{-1000, 1000, "1"};
  r.number("fx_px", lens.fx_px, focal, {.help = "focal length across, from the calibration"});
  r.number("fy_px", lens.fy_px, focal, {.help = "focal length down"});
  r.number("cx_px", lens.cx_px, centre, {.help = "principal point across; the centre of the top-left pixel is 0"});
  r.number("cy_px", lens.cy_px, centre, {.help = "principal point down"});
  r.number("k1", lens.k1, coefficient, {.help = "radial distortion, r^2 (OpenCV's order: k1, k2, p1, p2, k3)"});
  r.number("k2", lens.k2, coefficient, {.help = "radial, r^4", .fallback = 0});
  r.number("p1", lens.p1, coefficient, {.help = "tangential", .fallback = 0});
  r.number("p2", lens.p2, coefficient, {.help = "tangential", .fallback = 0});
  r.number("k3", lens.k3, coefficient, {.help = "radial, r^6", .fallback = 0});
}

void read_mark(ObjectReader& r, CameraView& view) {
  std::vector<double> px, m;
  r.numbers("px", px, {-1, 1e6, "px"}, 2, 2,
            {.help = "where the mark is in the picture as taken: across, down; centre of the top-left pixel = 0, 0"});
  r.numbers("mm", m, {-1000, 11000, "mm"}, 2, 2, {.help = "where it is on the slab: from its left edge, from its top edge"});
  if (px.size() == 2 && m.size() == 2) view.marks.push_back({{px[0], px[1]}, {m[0], m[1]}});
}

void read_homography(ObjectReader& r, CameraView& view) {
  std::vector<double> h;
  r.numbers("mm_from_px", h, {-1e12, 1e12, "1"}, 9, 9,
            {.help = "homography, row by row: slab mm from undistorted picture px; instead of marks", .fallback = std::vector<double>{}});
  if (h.size() != 9) return;
  Eigen::Matrix3d mm;
  mm << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  view.slab_m_from_ideal_px = Eigen::DiagonalMatrix<double, 3>(1e-3, 1e-3, 1.0) * mm;
}
}  // namespace

void read_camera_keys(ObjectReader& r, CameraView& view) {
  int format = 0, version = 0;
  r.choice("format", format, {{"venato-camera", 1}}, {.help = "what kind of file this is"});
  r.integer("version", version, {1, 1, ""}, {.help = "version of this format"});
  std::vector<double> slab_m;
  r.numbers("slab_mm", slab_m, {80, 10000, "mm"}, 2, 2, {.help = "width and height of the slab"});
  r.number("pitch_mm", view.pitch_m, {0.05, 5, "mm"}, {.help = "pixel size to bring the picture to", .fallback = 0.5});
  r.number("margin_mm", view.margin_m, {0, 500, "mm"}, {.help = "rim of the slab that is not used (chamfer, belt in view)", .fallback = 0});
  r.number("mark_limit_mm", view.mark_limit_m, {0.01, 20, "mm"},
           {.help = "a mark farther off the fit than this is an error; needs five marks or more", .fallback = 0.5});
  const bool marks = r.has("marks"), homography = r.has("mm_from_px");
  if (r.describing() || marks)
    r.objects("marks", "four or more places known on the slab and in the picture", 4, kMostMarks,
              [&](ObjectReader& m, std::size_t) { read_mark(m, view); });
  if (r.describing() || homography) read_homography(r, view);
  r.optional_object("lens", "distortion of the lens (Brown-Conrady, as OpenCV calibrates it); absent: none", [&](ObjectReader& l) {
    view.lens.emplace();
    read_lens(l, *view.lens);
  });
  if (r.describing()) return;
  if (marks && homography) r.issue("mm_from_px", "and marks are both given: one of them says where the slab is");
  // Misspelt keys are reported by name; which of the two was meant cannot be told then.
  if (!marks && !homography) r.issue("marks", "is missing: give four marks or more, or the homography mm_from_px");
  if (slab_m.size() != 2) return;
  view.width_m = slab_m[0];
  view.height_m = slab_m[1];
  if (view.width_m * view.height_m > kMaxSlabPixels * view.pitch_m * view.pitch_m)
    r.issue("pitch_mm", "makes a picture of more than 2.5e8 px of this slab", "give a coarser pitch_mm; 0.5 is enough for veins");
  if (2 * view.margin_m >= std::min(view.width_m, view.height_m)) r.issue("margin_mm", "leaves nothing of the slab");
}

CameraView read_camera(const std::filesystem::path& file) {
  CameraView view;
  read_config_file(file, {}, [&](ObjectReader& r) {
    view = {};
    read_camera_keys(r, view);
  }).throw_if_bad();
  view.file = file;
  return view;
}
}  // namespace venato::graphics
