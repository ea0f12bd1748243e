#pragma once
/// What the files of one mask set have in common. Internal to sync/mask.
#include <exception>
#include <mutex>
#include "sync/mask/mask_job.h"
#include "sync/warp/warp.h"
namespace venato::sync {

inline constexpr double kBigTiffFrom_bytes = 3.6 * 1073741824.0;  ///< classic TIFF ends at 4 GiB; the prediction comes from 2 % of the strips

const char* ink_polarity_text(Polarity polarity);
/// Tags that every TIFF of a set shares: size, dpi, compression, one line for ImageDescription. \param what "print, 0 = no ink" and the like
graphics::TiffInfo tiff_info(const MaskJob& job, const WarpGrid& grid, double dpi, const std::string& what);
/// An entry of the sidecar; a size of 0 = no picture.
MaskFile about(std::string name, std::string role, std::string polarity, std::int64_t width_px = 0, std::int64_t height_px = 0, int channels = 0,
               double dpi = 0);
/// Fills in size and SHA-256 of a finished file.
void seal(MaskFile& file, const std::filesystem::path& folder);

/// `work(k)` for k in [0, n) on several threads; the first exception goes on after all have ended.
template <class Work>
void for_each_parallel(int n, int threads, Work work) {
  std::exception_ptr error;
  std::mutex guard;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (int k = 0; k < n; ++k) {
    try {
      work(k);
    } catch (...) {
      const std::lock_guard lock(guard);
      if (!error) error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
}
}  // namespace venato::sync
