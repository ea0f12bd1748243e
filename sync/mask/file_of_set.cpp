#include "sync/mask/file_of_set.h"

#include <cstdio>

#include "base/io/sha256.h"

namespace venato::sync {
namespace {
constexpr int kRowsPerStrip = 64;

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
}  // namespace

const char* ink_polarity_text(Polarity p) { return p == Polarity::zero_is_no_ink ? "0 = no ink" : "0 = full ink"; }

graphics::TiffInfo tiff_info(const MaskJob& job, const WarpGrid& grid, double dpi, const std::string& what) {
  graphics::TiffInfo info;
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

MaskFile about(std::string name, std::string role, std::string polarity, std::int64_t width_px, std::int64_t height_px, int channels, double dpi) {
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

void seal(MaskFile& file, const std::filesystem::path& folder) {
  file.bytes = std::filesystem::file_size(folder / file.name);
  file.sha256 = sha256_of_file(folder / file.name);
}
}  // namespace venato::sync
