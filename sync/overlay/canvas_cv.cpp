#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "sync/overlay/canvas.h"

namespace venato::sync {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapital_px = 21;  // height of a capital of this font at scale 1
constexpr int kSubpixelBits = 4;

cv::Mat view(graphics::Raster8& canvas) { return cv::Mat(canvas.height, canvas.width, CV_8UC3, canvas.data.data()); }
cv::Scalar scalar(Rgb c) { return cv::Scalar(c[0], c[1], c[2]); }
int text_thickness(int size_px) { return size_px >= 18 ? 2 : 1; }

}  // namespace

void fill_box(graphics::Raster8& canvas, int x, int y, int width, int height, Rgb colour) {
  cv::Mat m = view(canvas);
  cv::rectangle(m, cv::Rect(x, y, width, height), scalar(colour), cv::FILLED);
}

void paste(graphics::Raster8& canvas, const graphics::Raster8& picture, int x, int y) {
  for (int j = 0; j < picture.height; ++j) {
    if (y + j < 0 || y + j >= canvas.height) continue;
    for (int i = 0; i < picture.width; ++i)
      if (x + i >= 0 && x + i < canvas.width)
        for (int c = 0; c < 3; ++c) canvas.at(x + i, y + j, c) = picture.at(i, j, c);
  }
}

void draw_line(graphics::Raster8& canvas, int x0, int y0, int x1, int y1, Rgb colour, int thickness) {
  cv::Mat m = view(canvas);
  cv::line(m, {x0, y0}, {x1, y1}, scalar(colour), thickness, cv::LINE_8);
}

void draw_dot(graphics::Raster8& canvas, double x, double y, double radius, Rgb colour) {
  cv::Mat m = view(canvas);
  const auto fixed = [](double v) { return static_cast<int>(std::lround(v * (1 << kSubpixelBits))); };
  cv::circle(m, {fixed(x), fixed(y)}, fixed(radius), scalar(colour), cv::FILLED, cv::LINE_AA, kSubpixelBits);
}

int text_width_px(const std::string& text, int size_px) {
  int base = 0;
  return cv::getTextSize(text, kFont, size_px / kCapital_px, text_thickness(size_px), &base).width;
}

void draw_text(graphics::Raster8& canvas, const std::string& text, int x, int y, int size_px, Rgb colour, Align align) {
  cv::Mat m = view(canvas);
  const int width = text_width_px(text, size_px);
  const int left = align == Align::left ? x : align == Align::centre ? x - width / 2 : x - width;
  cv::putText(m, text, {left, y}, kFont, size_px / kCapital_px, scalar(colour), text_thickness(size_px), cv::LINE_AA);
}

double round_step(double span, int most) {
  const double least = span / std::max(1, most), power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= least * (1 - 1e-9)) return m * power;
  return 10 * power;
}

void draw_mm_axes(graphics::Raster8& canvas, int x, int y, int width, int height, double px_per_m, int size_px) {
  const int tick = std::max(3, size_px / 3);
  fill_box(canvas, x - 1, y - 1, width + 2, 1, kInk);
  fill_box(canvas, x - 1, y + height, width + 2, 1, kInk);
  fill_box(canvas, x - 1, y - 1, 1, height + 2, kInk);
  fill_box(canvas, x + width, y - 1, 1, height + 2, kInk);
  const double px_per_mm = px_per_m / 1e3;
  const double step_mm = round_step(std::max(width, height) / px_per_mm, 12);
  const auto label = [](double mm) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", mm);
    return std::string(text);
  };
  for (int k = 0; k * step_mm * px_per_mm <= width + 0.5; ++k) {
    const int at = x + static_cast<int>(std::lround(k * step_mm * px_per_mm));
    draw_line(canvas, at, y + height, at, y + height + tick, kInk);
    draw_text(canvas, label(k * step_mm), at, y + height + tick + size_px + 4, size_px, kInk, Align::centre);
  }
  for (int k = 0; k * step_mm * px_per_mm <= height + 0.5; ++k) {
    const int at = y + static_cast<int>(std::lround(k * step_mm * px_per_mm));
    draw_line(canvas, x - tick, at, x, at, kInk);
    draw_text(canvas, label(k * step_mm), x - tick - 4, at + size_px / 2, size_px, kInk, Align::right);
  }
}

}  // namespace venato::sync
