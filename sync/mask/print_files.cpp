#include "sync/mask/print_files.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "graphics/icc/separate_by_profile.h"
#include "sync/mask/file_of_set.h"
#include "sync/mask/powder_rows.h"
#include "sync/mask/preview.h"

namespace venato::sync {
namespace {

using graphics::TiffInfo;
using graphics::TiffStripWriter;

/// Seconds since the last call.
class Lap {
 public:
  double operator()() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

struct OpenFile {
  MaskFile file;
  TiffInfo info;
  std::unique_ptr<TiffStripWriter> writer;
};

OpenFile open(const TiffInfo& info, const std::filesystem::path& folder, const std::string& name, const char* role, const char* polarity) {
  return {about(name, role, polarity, info.width, info.height, info.channels, info.dpi), info,
          std::make_unique<TiffStripWriter>(folder / name, info, 1)};
}

/// print.tif first, then the ink files in ink order, then the powders.
std::vector<OpenFile> open_files(const MaskJob& job, const WarpGrid& grid, const TiffInfo& print_info, const std::filesystem::path& folder) {
  std::vector<OpenFile> files;
  files.push_back(open(print_info, folder, "print.tif", "print", ink_polarity_text(job.print_polarity)));
  const auto grey = [&](const std::string& name, const char* role, const char* polarity) {
    files.push_back(open(tiff_info(job, grid, job.dpi, std::string(role) + ", " + polarity), folder, name, role, polarity));
  };
  for (const auto& ink : job.inks) grey("print_" + ink.name + ".tif", "ink", ink_polarity_text(job.ink_file_polarity));
  if (job.powders_at_print_resolution)
    for (const auto& powder : job.powders) grey("powder_" + powder.name + ".tif", "powder", "0 = none");
  return files;
}

/// What one thread needs; kept between strips so that nothing is allocated in the loop.
struct Worker {
  std::vector<std::uint8_t> rows, plane, scratch;
  graphics::StripCoder coder;
  std::vector<std::vector<std::uint8_t>> coded;  ///< this strip, for each file
  double warp_s = 0, compress_s = 0, write_s = 0;
};

}  // namespace

void write_print_files(const MaskJob& job, const PreparedLayers& layers, const WarpGrid& grid, const TiffInfo& print_info,
                       const std::filesystem::path& folder, MaskSet& set, Context& context) {
  const int inks = static_cast<int>(job.inks.size()), threads = std::max(1, context.threads);
  auto files = open_files(job, grid, print_info, folder);
  PreviewBuilder preview(grid.width, grid.height, grid.pitch_m, inks);
  const auto row_px = static_cast<std::size_t>(grid.width);
  const std::int64_t per_strip = print_info.rows_per_strip, strips = (grid.height + per_strip - 1) / per_strip;

  const auto make_strip = [&](Worker& w, std::int64_t first_row, int rows) {
    Lap lap;
    const std::size_t pixels = row_px * static_cast<std::size_t>(rows);
    w.rows.resize(pixels * static_cast<std::size_t>(inks));
    w.plane.resize(pixels);
    w.coded.resize(files.size());
    ink_rows(layers, grid, first_row, rows, w.rows, w.scratch, 1);
    preview.add_rows(first_row, w.rows);
    w.warp_s += lap();
    const auto encode = [&](std::size_t file, std::span<const std::uint8_t> samples) {
      const auto coded = w.coder.encode(files[file].info, samples);
      w.coded[file].assign(coded.begin(), coded.end());
    };
    for (std::size_t f = 1; f < files.size(); ++f) {
      const int ink = static_cast<int>(f) - 1;
      if (ink < inks)
        take_ink(w.rows, inks, ink, job.ink_file_polarity, w.plane);
      else
        powder_rows(job.powders[static_cast<std::size_t>(ink - inks)], grid, first_row, rows, w.plane, 1);
      encode(f, w.plane);
    }
    if (job.print_polarity == Polarity::zero_is_full_ink)
      for (auto& v : w.rows) v = static_cast<std::uint8_t>(255 - v);
    encode(0, w.rows);
    w.compress_s += lap();
  };

  context.progress.begin("print masks", static_cast<double>(grid.height), "rows");
  std::vector<Worker> workers(static_cast<std::size_t>(threads));
  std::exception_ptr error;
  std::atomic<bool> failed = false;
  const auto guarded = [&](const auto& work) {
    if (failed) return;
    try {
      work();
    } catch (...) {
      if (!failed.exchange(true)) error = std::current_exception();
    }
  };
  // Ordered: a thread whose strip is ready waits for its turn to write, then takes the next one. So at most `threads` strips are in memory.
#pragma omp parallel for ordered schedule(dynamic, 1) num_threads(threads)
  for (std::int64_t s = 0; s < strips; ++s) {
    Worker& w = workers[static_cast<std::size_t>(omp_get_thread_num())];
    const std::int64_t row = s * per_strip;
    const int rows = static_cast<int>(std::min(per_strip, grid.height - row));
    guarded([&] { make_strip(w, row, rows); });
#pragma omp ordered
    guarded([&] {
      if (context.stop_requested()) throw Interrupted("stopped while writing masks; nothing was kept of them");
      Lap lap;
      for (std::size_t f = 0; f < files.size(); ++f) files[f].writer->write_coded(w.coded[f], rows);
      w.write_s += lap();
      context.progress.at(static_cast<double>(row + rows));
    });
  }
  if (error) std::rethrow_exception(error);
  for (const Worker& w : workers) {
    set.times.warp_s += w.warp_s;
    set.times.compress_s += w.compress_s;
    set.times.write_s += w.write_s;
  }
  workers.clear();

  Lap lap;
  MaskFile picture_file;
  const int n = static_cast<int>(files.size());
  for_each_parallel(n + 1, threads, [&](int k) {
    if (k > 0) {
      files[static_cast<std::size_t>(k - 1)].writer->close();
      seal(files[static_cast<std::size_t>(k - 1)].file, folder);
      return;
    }
    const graphics::Raster8 amounts = preview.amounts();
    const graphics::Raster8 picture =
        job.profile ? graphics::see_by_profile(amounts, job.profile->file, 1).srgb : graphics::predict_srgb(job.inks, job.body_srgb, amounts);
    graphics::write_png(folder / "preview.png", picture);
    picture_file = about("preview.png", "preview", "sRGB", picture.width, picture.height, 3, kMetresPerInch / picture.pitch_m);
    seal(picture_file, folder);
  });
  set.times.finish_s = lap();
  context.progress.end();
  for (auto& file : files) set.files.push_back(std::move(file.file));
  set.files.push_back(std::move(picture_file));
}

}  // namespace venato::sync
