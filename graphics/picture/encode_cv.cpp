#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "graphics/graphic.h"
#include "graphics/picture/picture_header.h"
namespace venato::graphics {
namespace {
constexpr int kPngLevel = 6;
constexpr std::size_t kAfterIhdr = 8 + 25;  // signature + IHDR chunk

std::string encode(const Raster8& image, const char* extension, const std::vector<int>& parameters) {
  VENATO_EXPECTS(image.width > 0 && image.height > 0 && (image.channels == 1 || image.channels == 3 || image.channels == 4));
  const cv::Mat view(image.height, image.width, CV_8UC(image.channels), const_cast<std::uint8_t*>(image.data.data()));
  cv::Mat swapped;  // its own memory: converted in place, the caller's picture would change
  if (image.channels == 3) cv::cvtColor(view, swapped, cv::COLOR_RGB2BGR);
  if (image.channels == 4) cv::cvtColor(view, swapped, cv::COLOR_RGBA2BGRA);
  const cv::Mat& m = image.channels == 1 ? view : swapped;
  std::vector<std::uint8_t> bytes;
  try {
    if (!cv::imencode(extension, m, bytes, parameters)) throw WorkError(std::string("picture cannot be encoded as ") + extension);
  } catch (const cv::Exception& e) {
    throw WorkError(std::string("picture cannot be encoded as ") + extension + ": " + e.err);
  }
  return {bytes.begin(), bytes.end()};
}
void append_big32(std::string& s, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) s.push_back(static_cast<char>(v >> shift & 0xff));
}
}  // namespace

std::string encode_png(const Raster8& image) {
  std::string png = encode(image, ".png", {cv::IMWRITE_PNG_COMPRESSION, kPngLevel});
  const double per_metre = image.pitch_m > 0 ? std::round(1 / image.pitch_m) : 0;
  if (per_metre < 1 || per_metre > 2147483647.0) return png;
  std::string chunk = "pHYs";
  append_big32(chunk, static_cast<std::uint32_t>(per_metre));
  append_big32(chunk, static_cast<std::uint32_t>(per_metre));
  chunk.push_back(1);  // unit: metre
  std::string framed;
  append_big32(framed, 9);
  framed += chunk;
  append_big32(framed, png_crc(chunk));
  return png.insert(kAfterIhdr, framed);
}

std::string encode_jpeg(const Raster8& image, int quality) {
  VENATO_EXPECTS(quality >= 0 && quality <= 100 && image.channels != 4);
  std::string jpeg = encode(image, ".jpg", {cv::IMWRITE_JPEG_QUALITY, quality});
  // libjpeg's JFIF segment is the first one: density unit at byte 13. Densities are 16 bit integers: dots per cm are exact for whole mm/10.
  if (image.pitch_m <= 0 || jpeg.substr(6, 5) != std::string_view("JFIF\0", 5)) return jpeg;
  const double per_cm = 0.01 / image.pitch_m, per_inch = 0.0254 / image.pitch_m;
  const auto rounding = [](double v) { return std::abs(std::round(v) / v - 1); };
  const bool inch = rounding(per_inch) < rounding(per_cm);
  const double density = std::round(inch ? per_inch : per_cm);
  if (density < 1 || density > 65535) return jpeg;
  const auto d = static_cast<unsigned>(density);
  jpeg[13] = static_cast<char>(inch ? 1 : 2);
  jpeg[14] = jpeg[16] = static_cast<char>(d >> 8);
  jpeg[15] = jpeg[17] = static_cast<char>(d & 0xff);
  return jpeg;
}

void write_png(const std::filesystem::path& file, const Raster8& image) { write_text_atomically(file, encode_png(image)); }
}  // namespace venato::graphics
