#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include "base/expects.h"
#include "sync/registration/image_ops.h"
namespace venato::sync {
namespace {
constexpr double kDirectSigma_px = 8;  // larger Gaussians are smooth enough to be computed on a coarser grid
constexpr double kMinWeight = 0.05;    // below this share of valid neighbourhood a smoothed value would be an extrapolation

cv::Mat gaussian(const cv::Mat& m, double sigma_px) {
  cv::Mat out;
  const int size = 2 * static_cast<int>(std::ceil(3.5 * sigma_px)) + 1;
  cv::GaussianBlur(m, out, {size, size}, sigma_px, sigma_px, cv::BORDER_CONSTANT);  // outside = invalid = weight 0
  return out;
}

Feature smoothed(const Feature& f, double sigma_px, bool extend) {
  const int factor = sigma_px > kDirectSigma_px ? static_cast<int>(sigma_px / (kDirectSigma_px / 2)) : 1;
  Feature small = factor > 1 ? downsample(f, factor) : f;
  cv::Mat value(small.value.height, small.value.width, CV_32F, small.value.data.data());
  const cv::Mat mask(small.valid.height, small.valid.width, CV_8U, small.valid.data.data());
  cv::Mat weight;
  mask.convertTo(weight, CV_32F, 1.0 / 255);
  cv::Mat sum = gaussian(value, sigma_px / factor), norm = gaussian(weight, sigma_px / factor);
  if (factor > 1) {
    // Pixel centres: coarse I covers fine [I k, (I + 1) k), so the affine map has the half-pixel shift that cv::resize applies by itself
    // only when the sizes divide.
    const double k = factor;
    const cv::Matx23d coarse_from_fine(1 / k, 0, 0.5 / k - 0.5, 0, 1 / k, 0.5 / k - 0.5);
    const cv::Size size(f.value.width, f.value.height);
    cv::warpAffine(sum, sum, coarse_from_fine, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
    cv::warpAffine(norm, norm, coarse_from_fine, size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  }
  Feature out = f;
  for (int j = 0; j < f.value.height; ++j) {
    const auto* s = sum.ptr<float>(j);
    const auto* n = norm.ptr<float>(j);
    for (int i = 0; i < f.value.width; ++i) {
      const std::size_t k = f.value.index(i, j);
      const bool ok = (extend || f.valid.data[k]) && n[i] > kMinWeight;
      out.valid.data[k] = ok ? 255 : 0;
      out.value.data[k] = ok ? s[i] / n[i] : 0;
    }
  }
  return out;
}
}  // namespace

Feature without_rim(Feature f, int radius_px) {
  if (radius_px <= 0) return f;
  cv::Mat valid(f.valid.height, f.valid.width, CV_8U, f.valid.data.data()), shrunk;
  cv::erode(valid, shrunk, cv::getStructuringElement(cv::MORPH_RECT, {2 * radius_px + 1, 2 * radius_px + 1}), {-1, -1}, 1, cv::BORDER_CONSTANT,
            cv::Scalar(0));
  shrunk.copyTo(valid);
  for (std::size_t k = 0; k < f.value.data.size(); ++k)
    if (!f.valid.data[k]) f.value.data[k] = 0;
  return f;
}
Feature smooth(const Feature& f, double sigma_px) {
  VENATO_EXPECTS(!f.value.empty());
  return sigma_px > 0 ? smoothed(f, sigma_px, false) : f;
}
Feature smooth_and_extend(const Feature& f, double sigma_px) {
  VENATO_EXPECTS(!f.value.empty() && sigma_px > 0);
  return smoothed(f, sigma_px, true);
}
}  // namespace venato::sync
