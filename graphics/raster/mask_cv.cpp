#include "graphics/raster/mask.h"

#include <opencv2/imgproc.hpp>
namespace venato::graphics {
namespace {
constexpr float kFar_px = 1e6f;

cv::Mat view(const Raster8& r) { return {r.height, r.width, CV_8U, const_cast<std::uint8_t*>(r.data.data())}; }
cv::Mat view(RasterF& r) { return {r.height, r.width, CV_32FC(r.channels), r.data.data()}; }

Raster8 without_small(const Raster8& mask, double min_pixels, int connectivity, bool keep_at_border) {
  cv::Mat labels, stats, centres;
  const int n = cv::connectedComponentsWithStats(view(mask), labels, stats, centres, connectivity, CV_32S, cv::CCL_WU);
  std::vector<std::uint8_t> keep(static_cast<std::size_t>(n), 0);
  for (int k = 1; k < n; ++k) {
    const int* s = stats.ptr<int>(k);
    const bool border = s[cv::CC_STAT_LEFT] == 0 || s[cv::CC_STAT_TOP] == 0 || s[cv::CC_STAT_LEFT] + s[cv::CC_STAT_WIDTH] == mask.width ||
                        s[cv::CC_STAT_TOP] + s[cv::CC_STAT_HEIGHT] == mask.height;
    keep[static_cast<std::size_t>(k)] = s[cv::CC_STAT_AREA] >= min_pixels || (keep_at_border && border);
  }
  Raster8 out(mask.width, mask.height, 1, mask.pitch_m);
  for (int j = 0; j < mask.height; ++j)
    for (int i = 0; i < mask.width; ++i) out.at(i, j) = keep[static_cast<std::size_t>(labels.at<int>(j, i))] ? 255 : 0;
  return out;
}
Raster8 inverted(const Raster8& mask) {
  Raster8 out = mask;
  for (auto& v : out.data) v = v ? 0 : 255;
  return out;
}
}  // namespace

RasterF distance_to(const Raster8& mask) {
  VENATO_EXPECTS(mask.channels == 1);
  RasterF out(mask.width, mask.height, 1, mask.pitch_m, kFar_px);
  bool any = false;
  for (auto v : mask.data) any = any || v != 0;
  if (!any) return out;
  cv::Mat distance = view(out);
  cv::distanceTransform(view(inverted(mask)), distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return out;
}

RasterF signed_distance(const Raster8& mask) {
  const RasterF outside = distance_to(mask);
  RasterF out = distance_to(inverted(mask));
  for (std::size_t k = 0; k < out.data.size(); ++k) out.data[k] = mask.data[k] ? out.data[k] - 0.5f : 0.5f - outside.data[k];
  return out;
}

Raster8 without_small_parts(const Raster8& mask, double min_pixels) { return without_small(mask, min_pixels, 8, false); }
Raster8 without_small_holes(const Raster8& mask, double min_pixels) { return inverted(without_small(inverted(mask), min_pixels, 4, true)); }

Raster8 continued_outside(const Raster8& image, const Raster8& mask) {
  VENATO_EXPECTS(mask.channels == 1 && mask.width == image.width && mask.height == image.height);
  std::size_t inside = 0;
  for (auto v : mask.data) inside += v != 0;
  if (inside == 0 || inside == mask.data.size()) return image;
  cv::Mat distance, label;  // every zero pixel of the inverted mask has a label of its own
  cv::distanceTransform(view(inverted(mask)), distance, label, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<std::size_t> source(inside + 1, 0);
  for (int j = 0; j < mask.height; ++j)
    for (int i = 0; i < mask.width; ++i)
      if (mask.at(i, j)) source[static_cast<std::size_t>(label.at<int>(j, i))] = image.index(i, j);
  Raster8 out = image;
  for (int j = 0; j < mask.height; ++j)
    for (int i = 0; i < mask.width; ++i)
      if (!mask.at(i, j))
        for (int c = 0; c < image.channels; ++c)
          out.at(i, j, c) = image.data[source[static_cast<std::size_t>(label.at<int>(j, i))] + static_cast<std::size_t>(c)];
  return out;
}

RasterF gaussian(const RasterF& image, double sigma_px) {
  if (!(sigma_px > 0)) return image;
  RasterF out = image;
  cv::Mat m = view(out);
  cv::GaussianBlur(m.clone(), m, cv::Size(0, 0), sigma_px, sigma_px, cv::BORDER_REFLECT);
  return out;
}
}  // namespace venato::graphics
