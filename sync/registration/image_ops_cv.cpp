#include <opencv2/imgproc.hpp>
#include "sync/registration/image_ops.h"
namespace venato::sync {

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
}  // namespace venato::sync
