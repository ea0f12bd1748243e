#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/units.h"
#include "graphics/graphic.h"
#include "graphics/picture/flatten.h"
#include "graphics/picture/picture_header.h"
#include "graphics/tiff/tiff_picture.h"
namespace venato::graphics {
namespace {
constexpr std::uintmax_t kMaxFile_bytes = 0x7fffffff;  // OpenCV takes a file in memory as one row of int length
constexpr double kOpenCvMaxPixels = 1073741824.0;      // 2^30, its own limit
constexpr std::int64_t kOpenCvMaxSide_px = 1 << 20;
constexpr double kSquareTolerance = 2e-3;  // pHYs and JFIF round to integers

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) { throw UsageError(file.string() + ": " + reason); }

Raster8 decode(const std::filesystem::path& file, const std::string& bytes, const PictureHeader& header) {
  cv::Mat m;
  try {
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    m = cv::imdecode(raw, cv::IMREAD_UNCHANGED);  // unchanged: no EXIF rotation, 16 bit and alpha kept
  } catch (const cv::Exception& e) {
    refuse(file, "cannot be decoded: " + e.err);
  }
  if (m.empty()) refuse(file, "corrupt: its picture data cannot be decoded");
  if (m.cols != header.width || m.rows != header.height) refuse(file, "corrupt: header and picture data differ in size");
  SampleLayout layout;
  layout.stride = m.channels();
  layout.colours = m.channels() >= 3 ? 3 : 1;
  layout.alpha = m.channels() == 2 || m.channels() == 4 ? Alpha::straight : Alpha::none;
  layout.blue_first = layout.colours == 3;
  if (!m.isContinuous()) m = m.clone();
  const std::size_t samples = m.total() * static_cast<std::size_t>(m.channels());
  if (m.depth() == CV_8U) return flatten<std::uint8_t>(std::span<const std::uint8_t>(m.ptr<std::uint8_t>(), samples), m.cols, m.rows, layout);
  if (m.depth() == CV_16U) return flatten<std::uint16_t>(std::span<const std::uint16_t>(m.ptr<std::uint16_t>(), samples), m.cols, m.rows, layout);
  refuse(file, "has samples that are neither 8 nor 16 bit");
}

double pitch_from_dpi(const std::filesystem::path& file, double dpi_x, double dpi_y) {
  const std::string how = "; give the pitch in mm per pixel (config key or --graphic-pitch-mm / --vein-pitch-mm)";
  if (!(dpi_x > 0) || !(dpi_y > 0)) refuse(file, "has no dpi" + how);
  if (std::abs(dpi_x - dpi_y) > kSquareTolerance * dpi_x)
    refuse(file, "pixels are not square (" + std::to_string(dpi_x) + " x " + std::to_string(dpi_y) + " dpi)" + how);
  return kMetresPerInch / dpi_x;
}
}  // namespace

Picture load_picture(const std::filesystem::path& file, std::optional<double> pitch_m, double max_pixels) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) refuse(file, "no such file");
  if (!std::filesystem::is_regular_file(file, error)) refuse(file, "is not a regular file");
  if (std::filesystem::file_size(file, error) == 0) refuse(file, "is empty (0 bytes)");
  if (pitch_m && !(*pitch_m > 0 && std::isfinite(*pitch_m))) refuse(file, "pitch must be positive");
  Picture picture;
  double dpi_x = 0, dpi_y = 0;
  std::string head(8, '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  const auto format = picture_format(head);  // TIFFs may be larger than memory: only PNG and JPEG are read whole
  if (!format) refuse(file, "is not a PNG, JPEG or TIFF picture (by its first bytes)");
  if (*format == PictureFormat::tiff) {
    auto tiff = read_tiff_picture(file, max_pixels);
    picture.pixels = std::move(tiff.pixels);
    dpi_x = tiff.dpi_x;
    dpi_y = tiff.dpi_y;
  } else {
    const std::string bytes = read_file(file, kMaxFile_bytes);
    PictureHeader header;
    try {
      header = *format == PictureFormat::png ? read_png_header(bytes) : read_jpeg_header(bytes);
    } catch (const UsageError& e) {
      refuse(file, e.what());
    }
    const double limit = std::min(max_pixels, kOpenCvMaxPixels);
    if (static_cast<double>(header.width) * static_cast<double>(header.height) > limit)
      refuse(file, too_many_pixels(header.width, header.height, limit));
    if (std::max(header.width, header.height) > kOpenCvMaxSide_px) refuse(file, "a side has more than 2^20 px");
    if (!pitch_m) pitch_from_dpi(file, header.dpi_x, header.dpi_y);  // before the work of decoding
    picture.pixels = decode(file, bytes, header);
    dpi_x = header.dpi_x;
    dpi_y = header.dpi_y;
  }
  picture.pitch_from_file = !pitch_m;
  picture.pixels.pitch_m = pitch_m ? *pitch_m : pitch_from_dpi(file, dpi_x, dpi_y);
  return picture;
}
}  // namespace venato::graphics
