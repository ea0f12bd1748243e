#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/units.h"
#include "sync/mask/check_job.h"
#include "sync/mask/file_of_set.h"
#include "sync/mask/ink_rows.h"
#include "sync/mask/mask_job.h"
#include "sync/mask/powder_rows.h"
#include "sync/mask/print_files.h"
#include "sync/mask/print_size.h"
#include "sync/mask/staged_folder.h"

namespace venato::sync {
namespace {

using graphics::TiffInfo;
using graphics::TiffKind;

constexpr double kSizeMargin = 1.25;        // of the prediction, for the free space asked for
constexpr double kSpareSpace_bytes = 32e6;  // preview, feeds, sidecar

void write_powders_at_own_pitch(const MaskJob& job, const std::filesystem::path& folder, MaskSet& set, int threads) {
  for (const PowderMask& powder : job.powders) {
    const WarpGrid grid = own_grid(powder);
    TiffInfo info = tiff_info(job, grid, kMetresPerInch / grid.pitch_m, "powder, 0 = none");
    std::vector<std::uint8_t> rows(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
    powder_rows(powder, grid, 0, static_cast<int>(grid.height), rows, threads);
    const std::string name = "powder_" + powder.name + ".tif";
    graphics::TiffStripWriter writer(folder / name, info, threads);
    writer.write_rows(rows);
    writer.close();
    set.files.push_back(about(name, "powder", "0 = none", grid.width, grid.height, 1, info.dpi));
  }
}

void write_feeds(const MaskJob& job, const std::filesystem::path& folder, MaskSet& set) {
  for (const FeedFile& feed : job.feeds) {
    write_feed(feed, folder);
    set.files.push_back(about("feed_" + feed.name + ".csv", "feed_table", "0 = off, 1 = full duty"));
    set.files.push_back(
        about("feed_" + feed.name + ".tif", "feed_picture", "0 = off", feed.prongs, feed.ticks, 1, kMetresPerInch / feed.prong_pitch_m));
  }
}

}  // namespace

MaskSet write_masks(const MaskJob& job, const std::filesystem::path& folder, Context& context) {
  check_job(job);
  const int threads = std::max(1, context.threads);
  MaskSet set;
  set.pitch_m = kMetresPerInch / job.dpi;
  set.width_px = std::max<std::int64_t>(1, std::llround(job.width_m / set.pitch_m));
  set.height_px = std::max<std::int64_t>(1, std::llround(job.height_m / set.pitch_m));
  const WarpGrid grid{set.width_px, set.height_px, set.pitch_m};
  const PreparedLayers layers = prepare_layers(job, grid);

  TiffInfo print_info = tiff_info(job, grid, job.dpi, "print, " + std::string(ink_polarity_text(job.print_polarity)));
  print_info.kind = TiffKind::separated;
  print_info.channels = static_cast<int>(job.inks.size());
  for (const auto& ink : job.inks) print_info.ink_names.push_back(ink.name);
  // A profile counts 0 as no ink; readers would apply it to the samples as they stand.
  if (job.profile && job.print_polarity == Polarity::zero_is_no_ink) print_info.icc_profile = job.profile->bytes;
  print_info.no_ink_value = job.print_polarity == Polarity::zero_is_no_ink ? 0 : 255;

  StagedFolder staged(folder);
  set.predicted_print_bytes = predict_print_bytes(job, layers, grid, print_info, threads);
  print_info.big_tiff = set.big_tiff = set.predicted_print_bytes > kBigTiffFrom_bytes;
  if (set.big_tiff) context.log.info("print.tif is written as BigTIFF: more than 3.6 GiB predicted (older RIPs refuse BigTIFF)");
  double powder_bytes = 0;
  for (const PowderMask& powder : job.powders) {
    const WarpGrid g = job.powders_at_print_resolution ? grid : own_grid(powder);
    powder_bytes += static_cast<double>(g.width) * static_cast<double>(g.height);
  }
  // Twice the print: once interleaved, once as ink files.
  require_free_space(folder, static_cast<std::uintmax_t>(2 * kSizeMargin * set.predicted_print_bytes + powder_bytes + kSpareSpace_bytes), "masks");

  write_print_files(job, layers, grid, print_info, staged.path(), set, context);
  if (!job.powders_at_print_resolution) write_powders_at_own_pitch(job, staged.path(), set, threads);
  write_feeds(job, staged.path(), set);
  for_each_parallel(static_cast<int>(set.files.size()), threads, [&](int k) {
    MaskFile& file = set.files[static_cast<std::size_t>(k)];
    if (file.sha256.empty()) seal(file, staged.path());
  });
  write_text_atomically(staged.path() / "masks.json", masks_json_text(job, set));
  staged.publish("masks.json");
  return set;
}

}  // namespace venato::sync
