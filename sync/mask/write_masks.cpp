#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/io/sha256.h"
#include "base/units.h"
#include "sync/mask/check_job.h"
#include "sync/mask/ink_rows.h"
#include "sync/mask/mask_job.h"
#include "sync/mask/powder_rows.h"
#include "sync/mask/preview.h"
#include "sync/mask/print_size.h"
#include "sync/mask/staged_folder.h"

namespace venato::sync {
namespace {

using graphics::TiffInfo;
using graphics::TiffKind;
using graphics::TiffStripWriter;

constexpr double kBigTiffFrom_bytes = 3.6 * 1073741824.0;  // classic TIFF ends at 4 GiB; the prediction comes from 2 % of the strips
constexpr double kSizeMargin = 1.25;                       // of the prediction, for the free space asked for
constexpr double kSpareSpace_bytes = 32e6;                 // preview, feeds, sidecar
constexpr int kRowsPerStrip = 64, kStripsAtOnce = 4;       // the writer compresses 4 strips per thread at a time: hand it whole batches

const char* ink_polarity_text(Polarity p) { return p == Polarity::zero_is_no_ink ? "0 = no ink" : "0 = full ink"; }

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

/// One line for ImageDescription: what a person at the printer looks for first.
std::string description(const MaskJob& job, const WarpGrid& grid, const std::string& what) {
  char numbers[160];
  std::snprintf(numbers, sizeof numbers, R"(,"frame":"green","width_mm":%.3f,"height_mm":%.3f,"mm_per_px":%.9f,"synchronised":%s})",
                job.width_m * 1e3, job.height_m * 1e3, grid.pitch_m * 1e3, job.synchronised ? "true" : "false");
  std::string id;  // only printable ASCII without quotes: the tag is 7 bit
  for (const char c : job.slab_id)
    if (c >= ' ' && c <= '~' && c != '"' && c != '\\') id += c;
  return R"({"what":")" + what + R"(","slab_id":")" + id + "\"" + numbers;
}

TiffInfo tiff_info(const MaskJob& job, const WarpGrid& grid, double dpi, const std::string& what) {
  TiffInfo info;
  info.width = grid.width;
  info.height = grid.height;
  info.dpi = dpi;
  info.compression = job.compression;
  info.rows_per_strip = kRowsPerStrip;
  info.description = description(job, grid, what);
  info.software = "venato";
  // A grey file can only grow by under 1 % (deflate, packbits; LZW up to 40 % on noise): judge its raw size.
  info.big_tiff = static_cast<double>(grid.width) * static_cast<double>(grid.height) > kBigTiffFrom_bytes / 1.1;
  return info;
}

MaskFile about(std::string name, std::string role, std::string polarity, std::int64_t width_px = 0, std::int64_t height_px = 0, int channels = 0,
               double dpi = 0) {
  MaskFile file;
  file.name = std::move(name);
  file.role = std::move(role);
  file.polarity = std::move(polarity);
  file.width_px = width_px;
  file.height_px = height_px;
  file.channels = channels;
  file.dpi = dpi;
  return file;
}

struct OpenFile {
  MaskFile file;
  std::unique_ptr<TiffStripWriter> writer;
};

OpenFile open_grey(const MaskJob& job, const std::filesystem::path& folder, const WarpGrid& grid, double dpi, const std::string& name,
                   const std::string& role, const std::string& polarity, int threads) {
  TiffInfo info = tiff_info(job, grid, dpi, role + ", " + polarity);
  info.kind = TiffKind::grey;
  return {about(name, role, polarity, grid.width, grid.height, 1, dpi), std::make_unique<TiffStripWriter>(folder / name, info, threads)};
}

void invert(std::span<std::uint8_t> rows) {
  for (auto& v : rows) v = static_cast<std::uint8_t>(255 - v);
}

/// print.tif, the ink files, powders at print resolution and the preview, in one pass over the strips.
void write_print_files(const MaskJob& job, const PreparedLayers& layers, const WarpGrid& grid, const TiffInfo& print_info,
                       const std::filesystem::path& folder, MaskSet& set, Context& context) {
  const int inks = static_cast<int>(job.inks.size()), threads = std::max(1, context.threads);
  TiffStripWriter print(folder / "print.tif", print_info, threads);
  std::vector<OpenFile> grey;
  for (const auto& ink : job.inks)
    grey.push_back(open_grey(job, folder, grid, job.dpi, "print_" + ink.name + ".tif", "ink", ink_polarity_text(job.ink_file_polarity), 1));
  if (job.powders_at_print_resolution)
    for (const auto& powder : job.powders)
      grey.push_back(open_grey(job, folder, grid, job.dpi, "powder_" + powder.name + ".tif", "powder", "0 = none", 1));
  const int greys = static_cast<int>(grey.size());

  const int batch = kRowsPerStrip * kStripsAtOnce * threads;
  const auto row_px = static_cast<std::size_t>(grid.width), row_bytes = row_px * static_cast<std::size_t>(inks);
  std::vector<std::uint8_t> rows_buffer(row_bytes * static_cast<std::size_t>(std::min<std::int64_t>(batch, grid.height))), scratch;
  std::vector<std::vector<std::uint8_t>> plane(static_cast<std::size_t>(threads));
  PreviewBuilder preview(grid.width, grid.height, grid.pitch_m, inks);

  context.progress.begin("print masks", static_cast<double>(grid.height), "rows");
  for (std::int64_t row = 0; row < grid.height; row += batch) {
    if (context.stop_requested()) throw Interrupted("stopped while writing masks; nothing was kept of them");
    const int rows = static_cast<int>(std::min<std::int64_t>(batch, grid.height - row));
    const std::span<std::uint8_t> strip = std::span(rows_buffer).first(row_bytes * static_cast<std::size_t>(rows));
    ink_rows(layers, grid, row, rows, strip, scratch, threads);
    preview.add_rows(strip);
    for_each_parallel(greys, threads, [&](int k) {
      std::vector<std::uint8_t> one(row_px * static_cast<std::size_t>(rows));
      if (k < inks)
        take_ink(strip, inks, k, job.ink_file_polarity, one);
      else
        powder_rows(job.powders[static_cast<std::size_t>(k - inks)], grid, row, rows, one, 1);
      grey[static_cast<std::size_t>(k)].writer->write_rows(one);
    });
    if (job.print_polarity == Polarity::zero_is_full_ink) invert(strip);
    print.write_rows(strip);
    context.progress.at(static_cast<double>(row + rows));
  }
  for_each_parallel(greys + 1, threads, [&](int k) { k < greys ? grey[static_cast<std::size_t>(k)].writer->close() : print.close(); });
  context.progress.end();

  set.files.push_back(about("print.tif", "print", ink_polarity_text(job.print_polarity), grid.width, grid.height, inks, job.dpi));
  for (auto& file : grey) set.files.push_back(std::move(file.file));
  const graphics::Raster8 picture = preview.picture(job.inks, job.body_srgb);
  graphics::write_png(folder / "preview.png", picture);
  set.files.push_back(about("preview.png", "preview", "sRGB", picture.width, picture.height, 3, kMetresPerInch / picture.pitch_m));
}

void write_powders_at_own_pitch(const MaskJob& job, const std::filesystem::path& folder, MaskSet& set, int threads) {
  for (const PowderMask& powder : job.powders) {
    const WarpGrid grid = own_grid(powder);
    OpenFile file = open_grey(job, folder, grid, kMetresPerInch / grid.pitch_m, "powder_" + powder.name + ".tif", "powder", "0 = none", threads);
    std::vector<std::uint8_t> rows(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
    powder_rows(powder, grid, 0, static_cast<int>(grid.height), rows, threads);
    file.writer->write_rows(rows);
    file.writer->close();
    set.files.push_back(std::move(file.file));
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
  print_info.no_ink_value = job.print_polarity == Polarity::zero_is_no_ink ? 0 : 255;

  StagedFolder staged(folder);
  set.predicted_print_bytes = predict_print_bytes(job, layers, grid, print_info, staged.path() / "sample.tif", threads);
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
    file.bytes = std::filesystem::file_size(staged.path() / file.name);
    file.sha256 = sha256_of_file(staged.path() / file.name);
  });
  write_text_atomically(staged.path() / "masks.json", masks_json_text(job, set));
  staged.publish("masks.json");
  return set;
}

}  // namespace venato::sync
