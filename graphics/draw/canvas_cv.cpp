#include "graphics/draw/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
namespace venato::graphics::detail {
namespace {
struct Font {
  double scale;
  int thickness;
};
Font font(TextSize s) { return s == TextSize::title ? Font{0.62, 2} : Font{0.48, 1}; }
cv::Mat view(Raster8& r) { return {r.height, r.width, CV_8UC3, r.data.data()}; }
cv::Scalar scalar(Srgb8 c) { return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])}; }
}  // namespace

int text_width(const std::string& text, TextSize size) {
  int below = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, font(size).scale, font(size).thickness, &below).width;
}
int text_height(TextSize size) { return size == TextSize::title ? 16 : 12; }
void draw_text(Raster8& image, const std::string& text, int x, int baseline, TextSize size) {
  cv::Mat m = view(image);
  cv::putText(m, text, {x, baseline}, cv::FONT_HERSHEY_SIMPLEX, font(size).scale, scalar(kInkColour), font(size).thickness, cv::LINE_AA);
}
void fill_rectangle(Raster8& image, int x, int y, int width, int height, Srgb8 colour) {
  cv::Mat m = view(image);
  cv::rectangle(m, cv::Rect(x, y, width, height), scalar(colour), cv::FILLED);
}
void paste(Raster8& image, const Raster8& part, int x, int y) {
  VENATO_EXPECTS(x >= 0 && y >= 0 && x + part.width <= image.width && y + part.height <= image.height && part.channels == 3);
  for (int j = 0; j < part.height; ++j) std::copy_n(&part.at(0, j), part.width * 3, &image.at(x, y + j));
}
std::string short_number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", v == 0 ? 0.0 : v);
  return text;
}
int draw_scale_bar(Raster8& image, double px_per_m, double width_m, int x, int y) {
  const double wanted_mm = width_m * 1e3 / 5, power = std::pow(10.0, std::floor(std::log10(wanted_mm)));
  const double lead = wanted_mm / power, length_mm = power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
  const int length_px = std::max(2, static_cast<int>(std::lround(length_mm * 1e-3 * px_per_m)));
  const std::string text = short_number(length_mm) + " mm";
  fill_rectangle(image, x, y, length_px, 4, kInkColour);
  draw_text(image, text, x + length_px + 8, y + 7, TextSize::small);
  return length_px + 8 + text_width(text, TextSize::small);
}
}  // namespace venato::graphics::detail
