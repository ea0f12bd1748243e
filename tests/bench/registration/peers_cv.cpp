#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include "sync/registration/image_ops.h"
#include "tests/bench/registration/peers.h"
namespace venato::bench {
namespace fs = std::filesystem;
using graphics::RasterF;
using sync::Point;
namespace {
double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
void write_mhd(const fs::path& file, const RasterF& r) {
  const fs::path raw = fs::path(file).replace_extension(".raw");
  std::ofstream(file) << "ObjectType = Image\nNDims = 2\nDimSize = " << r.width << ' ' << r.height
                      << "\nElementSpacing = 1 1\nOffset = 0 0\nElementType = MET_FLOAT\nElementByteOrderMSB = False\nElementDataFile = "
                      << raw.filename().string() << '\n';
  std::ofstream(raw, std::ios::binary).write(reinterpret_cast<const char*>(r.data.data()), static_cast<std::streamsize>(r.data.size() * 4));
}
cv::Mat mat(const RasterF& r) { return cv::Mat(r.height, r.width, CV_32F, const_cast<float*>(r.data.data())); }
}  // namespace

PeerResult run_elastix(const RasterF& green, const RasterF& print, const sync::Transform& pose, const std::string& parameters,
                       const std::string& folder, int threads) {
  PeerResult out;
  fs::remove_all(folder);
  fs::create_directories(folder);
  const sync::Feature whole = sync::resample({print, {}, sync::EvidenceKind::picture}, print.pitch_m, threads);
  sync::Feature placed = sync::warp_to_green(whole, pose, green.width, green.height, threads);
  const auto mean = static_cast<float>(sync::moments(placed, threads).mean);
  for (std::size_t k = 0; k < placed.value.data.size(); ++k)
    if (!placed.valid.data[k]) placed.value.data[k] = mean;
  write_mhd(fs::path(folder) / "fixed.mhd", green);
  write_mhd(fs::path(folder) / "moving.mhd", placed.value);
  const std::string in = "cd '" + folder + "' && ", quiet = " > log.txt 2>&1", workers = " -threads " + std::to_string(threads);
  const double start = now_s();
  if (std::system((in + "elastix -f fixed.mhd -m moving.mhd -p '" + fs::absolute(parameters).string() + "' -out ." + workers + quiet).c_str()) != 0)
    return out;
  out.seconds = now_s() - start;
  if (std::system((in + "transformix -def all -out . -tp TransformParameters.0.txt" + workers + quiet).c_str()) != 0) return out;
  auto field = std::make_shared<std::vector<float>>(green.data.size() * 2);
  std::ifstream raw(fs::path(folder) / "deformationField.raw", std::ios::binary);
  raw.read(reinterpret_cast<char*>(field->data()), static_cast<std::streamsize>(field->size() * 4));
  if (!raw) return out;
  const int w = green.width, h = green.height;
  out.print_from_green = [field, pose, w, h](Point p) {
    const int i = std::clamp(static_cast<int>(p.x() * 1e3), 0, w - 1), j = std::clamp(static_cast<int>(p.y() * 1e3), 0, h - 1);
    const std::size_t k = 2 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(w) + static_cast<std::size_t>(i));
    return pose(p + Point(static_cast<double>((*field)[k]), static_cast<double>((*field)[k + 1])) * 1e-3);
  };
  fs::remove_all(folder);
  out.ran = true;
  return out;
}

PeerResult run_plain_ecc(const RasterF& green, const RasterF& print, Point nominal_shift_m) {
  PeerResult out;
  const double start = now_s(), pitch = 0.004;
  cv::Mat g, p;
  cv::resize(mat(green), g, {}, 0.25, 0.25, cv::INTER_AREA);
  cv::resize(mat(print), p, {}, 0.25, 0.25, cv::INTER_AREA);
  const Point s = nominal_shift_m / pitch;
  cv::Mat warp = (cv::Mat_<float>(2, 3) << 1, 0, s.x(), 0, 1, s.y());
  try {
    cv::findTransformECC(g, p, warp, cv::MOTION_AFFINE, cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 80, 1e-6), cv::noArray(),
                         5);
  } catch (const cv::Exception&) {
    return out;
  }
  out.seconds = now_s() - start;
  out.ran = true;
  Eigen::Matrix2d a;
  a << static_cast<double>(warp.at<float>(0, 0)), static_cast<double>(warp.at<float>(0, 1)), static_cast<double>(warp.at<float>(1, 0)),
      static_cast<double>(warp.at<float>(1, 1));
  const Point t(static_cast<double>(warp.at<float>(0, 2)), static_cast<double>(warp.at<float>(1, 2))), half(0.5, 0.5);
  out.print_from_green = [a, t, half, pitch](Point q) { return Point((a * (q / pitch - half) + t + half) * pitch); };
  return out;
}
}  // namespace venato::bench
