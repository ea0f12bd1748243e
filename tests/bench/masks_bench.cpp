/// The mask set of a synthetic slab, and what the peers of tests/bench/masks_vs_peers need to do the same: see usage in main().
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "base/context.h"
#include "base/rng.h"
#include "base/store/store.h"
#include "base/units.h"
#include "sync/mask/ink_rows.h"
#include "sync/mask/mask_job.h"
#include "sync/warp/warp.h"

namespace {
namespace fs = std::filesystem;
using namespace venato;

constexpr double kDpi = 360, kPrintPitch_m = kMetresPerInch / kDpi;
constexpr int kFullWidth_px = 24400, kFullHeight_px = 48800;  // a slab of 1600 x 3200 mm fired, green size
constexpr int kInks = 6;
constexpr double kSourcePitch_m = 0.0004, kSpacing_m = 0.05, kAmplitude_m = 0.005;

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A smooth bend of up to 5 mm that is not symmetric in anything.
sync::Transform bend(double width_m, double height_m) {
  sync::Transform map;
  map.t = sync::Point(0.006, 0.006);
  map.u.spacing_m = kSpacing_m;
  map.u.nx = static_cast<int>(std::ceil(width_m / kSpacing_m)) + 3;
  map.u.ny = static_cast<int>(std::ceil(height_m / kSpacing_m)) + 3;
  for (int j = 0; j < map.u.ny; ++j)
    for (int i = 0; i < map.u.nx; ++i) {
      map.u.cx.push_back(kAmplitude_m * std::sin(0.31 * i + 0.17 * j));
      map.u.cy.push_back(kAmplitude_m * std::cos(0.23 * i - 0.29 * j));
    }
  return map;
}

/// Tones with veins and a grain of +-3 levels, as a scanned stone separated to inks has.
graphics::Raster8 artwork(int width, int height, int inks) {
  graphics::Raster8 image(width, height, inks, kSourcePitch_m);
  Rng rng(5, stream_id("bench/masks/grain"));
  std::size_t k = 0;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      for (int c = 0; c < inks; ++c) {
        const double tone = 110 + 90 * std::sin(0.011 * i * (1 + 0.2 * c) + 0.007 * j) * std::cos(0.003 * j * (c + 1));
        image.data[k++] = static_cast<std::uint8_t>(tone + static_cast<double>(rng.below(7)) - 3);
      }
  return image;
}

sync::MaskJob slab(double scale) {
  sync::MaskJob job;
  const char* names[kInks] = {"blue", "brown", "beige", "yellow", "pink", "black"};
  for (int k = 0; k < kInks; ++k) job.inks.push_back({names[k], {static_cast<std::uint8_t>(30 * k), 90, static_cast<std::uint8_t>(200 - 30 * k)}});
  job.body_srgb = {240, 236, 228};
  job.width_m = std::round(kFullWidth_px * scale) * kPrintPitch_m;
  job.height_m = std::round(kFullHeight_px * scale) * kPrintPitch_m;
  job.dpi = kDpi;
  job.print_from_green = job.pose_from_green = bend(job.width_m, job.height_m);
  const double margin_m = 0.012;
  job.layers.push_back(
      {"all",
       artwork(static_cast<int>((job.width_m + margin_m) / kSourcePitch_m), static_cast<int>((job.height_m + margin_m) / kSourcePitch_m), kInks),
       true});
  return job;
}

/// Source positions of every pixel (px, pixel centres at integers), two floats each: what vips mapim reads. Every `step`-th pixel both ways.
void write_positions(const sync::MaskJob& job, const fs::path& file, int step) {
  const sync::WarpGrid grid{std::llround(job.width_m / kPrintPitch_m), std::llround(job.height_m / kPrintPitch_m), kPrintPitch_m};
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (!out) throw std::runtime_error("cannot write " + file.string());
  std::vector<float> row;
  for (std::int64_t j = 0; j < grid.height; j += step) {
    const auto p = sync::source_positions(job.print_from_green, kSourcePitch_m, grid, j);
    row.clear();
    for (std::size_t i = 0; i < p.x.size(); i += static_cast<std::size_t>(step))
      row.push_back(static_cast<float>(p.x[i])), row.push_back(static_cast<float>(p.y[i]));
    std::fwrite(row.data(), sizeof(float), row.size(), out);
  }
  std::fclose(out);
}

/// Where every kStep-th source pixel lies on the print [px, y upwards]: gdalwarp's geolocation arrays, doubles. The inverse by fixed-point iteration:
/// the bend's slope is under 0.05, so 12 steps end at rounding.
constexpr int kStep = 4;
void write_geolocation(const sync::MaskJob& job, const fs::path& folder) {
  const auto& source = job.layers[0].ink;
  std::FILE* out[2] = {std::fopen((folder / "geo_x.raw").c_str(), "wb"), std::fopen((folder / "geo_y.raw").c_str(), "wb")};
  if (!out[0] || !out[1]) throw std::runtime_error("cannot write " + folder.string());
  for (int j = 0; j < source.height; j += kStep)
    for (int i = 0; i < source.width; i += kStep) {
      const sync::Point target((i + 0.5) * kSourcePitch_m, (j + 0.5) * kSourcePitch_m);
      sync::Point p = target - job.print_from_green.t;
      for (int n = 0; n < 12; ++n) p += target - job.print_from_green(p);
      const double xy[2] = {p.x() / kPrintPitch_m, -p.y() / kPrintPitch_m};
      for (int k = 0; k < 2; ++k) std::fwrite(&xy[k], sizeof(double), 1, out[k]);
    }
  std::fclose(out[0]);
  std::fclose(out[1]);
}

/// Runs a program: "wall seconds, CPU seconds, peak MiB".
int time_program(char** argv) {
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    ::execvp(argv[0], argv);
    ::_exit(127);
  }
  int status = 0;
  rusage u{};
  ::wait4(child, &status, 0, &u);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto s = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  std::printf("time %.2f %.2f %.0f\n", wall, s(u.ru_utime) + s(u.ru_stime), static_cast<double>(u.ru_maxrss) / 1024);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

/// print.tif alone, what the peers make: warp, compression, file.
void write_print(const sync::MaskJob& job, const sync::WarpGrid& grid, const fs::path& file, int threads) {
  const auto layers = sync::prepare_layers(job, grid);
  graphics::TiffInfo info;
  info.width = grid.width;
  info.height = grid.height;
  info.channels = kInks;
  info.dpi = kDpi;
  info.kind = graphics::TiffKind::separated;
  for (const auto& ink : job.inks) info.ink_names.push_back(ink.name);
  graphics::TiffStripWriter writer(file, info, threads);
  const int batch = 256 * threads;
  std::vector<std::uint8_t> out(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(batch) * kInks), scratch;
  double warp = 0, code = 0;
  for (std::int64_t row = 0; row < grid.height; row += batch) {
    const int rows = static_cast<int>(std::min<std::int64_t>(batch, grid.height - row));
    const auto strip = std::span(out).first(static_cast<std::size_t>(grid.width * rows * kInks));
    warp += seconds_of([&] { sync::ink_rows(layers, grid, row, rows, strip, scratch, threads); });
    code += seconds_of([&] { writer.write_rows(strip); });
  }
  const double close = seconds_of([&] { writer.close(); });
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("print_s %.2f warp_s %.2f compress_s %.2f disk_s %.2f peak_mib %.0f\n", warp + code + close, warp, code, close,
              static_cast<double>(usage.ru_maxrss) / 1024);
}

void kernel_rates() {
  const sync::WarpGrid grid{8192, 2048, kPrintPitch_m};
  const sync::Transform map = bend(0.578, 0.1445);
  const double mpx = static_cast<double>(grid.width * grid.height) / 1e6;
  const auto noise = [](int channels) {
    graphics::Raster8 image(8600, 2500, channels, kPrintPitch_m);
    std::uint32_t state = 1;
    for (auto& v : image.data) v = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
    return image;
  };
  const graphics::Raster8 five = noise(5), four = noise(4);
  std::vector<std::uint8_t> out(static_cast<std::size_t>(grid.width) * 64 * 5);
  cv::setNumThreads(1);
  const cv::Mat input(four.height, four.width, CV_8UC4, const_cast<std::uint8_t*>(four.data.data()));
  cv::Mat mx(static_cast<int>(grid.height), static_cast<int>(grid.width), CV_32F), my = mx.clone(), remapped;
  for (int j = 0; j < grid.height; ++j) {
    const auto p = sync::source_positions(map, kPrintPitch_m, grid, j);
    std::copy(p.x.begin(), p.x.end(), mx.ptr<float>(j));
    std::copy(p.y.begin(), p.y.end(), my.ptr<float>(j));
  }
  double ours = 1e9, remap = 1e9;
  for (int k = 0; k < 5; ++k) {
    ours = std::min(ours, seconds_of([&] {
                      for (int row = 0; row < grid.height; row += 64) sync::warp_rows(five, map, grid, row, 64, out, 1);
                    }));
    remap = std::min(remap, seconds_of([&] { cv::remap(input, remapped, mx, my, cv::INTER_LINEAR, cv::BORDER_CONSTANT); }));
  }
  std::printf("kernel ours_5_inks %.1f Mpx/s  cv_remap_4_channels %.1f Mpx/s  ratio %.2f\n", mpx / ours, mpx / remap, remap / ours);
}
}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "kernel") {
    kernel_rates();
    return 0;
  }
  if (what == "time" && argc > 2) return time_program(argv + 2);
  if (argc < 5 || (what != "set" && what != "warp" && what != "inputs" && what != "print")) {
    std::fprintf(stderr, "usage: masks_bench kernel | set|print|warp|inputs SCALE THREADS FOLDER | time PROGRAM ARGUMENT...\n");
    return 2;
  }
  const double scale = std::atof(argv[2]);
  const int threads = std::atoi(argv[3]);
  const fs::path folder = argv[4];
  fs::create_directories(folder);
  const sync::MaskJob job = slab(scale);
  const sync::WarpGrid grid{std::llround(job.width_m / kPrintPitch_m), std::llround(job.height_m / kPrintPitch_m), kPrintPitch_m};
  if (what == "inputs") {
    graphics::TiffInfo info;  // the peers take any channel count as grey with extra samples
    info.compression = graphics::TiffCompression::none;
    graphics::write_tiff(folder / "source.tif", job.layers[0].ink, info, threads);
    write_positions(job, folder / "positions.raw", 1);
    write_geolocation(job, folder);
    std::printf("size %lld %lld source %d %d\n", static_cast<long long>(grid.width), static_cast<long long>(grid.height), job.layers[0].ink.width,
                job.layers[0].ink.height);
    return 0;
  }
  if (what == "print") {
    write_print(job, grid, folder / "print.tif", threads);
    return 0;
  }
  if (what == "warp") {
    const auto layers = sync::prepare_layers(job, grid);
    std::vector<std::uint8_t> out(static_cast<std::size_t>(grid.width) * 256 * kInks), scratch;
    const double s = seconds_of([&] {
      for (std::int64_t row = 0; row < grid.height; row += 256) {
        const int rows = static_cast<int>(std::min<std::int64_t>(256, grid.height - row));
        sync::ink_rows(layers, grid, row, rows, std::span(out).first(static_cast<std::size_t>(grid.width * rows * kInks)), scratch, threads);
      }
    });
    std::printf("warp_s %.2f\n", s);
    return 0;
  }
  const auto log = make_null_log();
  const auto progress = make_null_progress();
  Store store{folder / "store"};
  Context context{*log, *progress, store, 1, threads, nullptr};
  sync::MaskSet set;
  const double wall = seconds_of([&] { set = sync::write_masks(job, folder / "masks", context); });
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  double bytes = 0;
  for (const auto& file : set.files) bytes += static_cast<double>(file.bytes);
  std::printf("set_s %.2f size %lld %lld bytes %.0f peak_mib %.0f warp_s %.2f compress_s %.2f write_s %.2f finish_s %.2f\n", wall,
              static_cast<long long>(set.width_px), static_cast<long long>(set.height_px), bytes, static_cast<double>(usage.ru_maxrss) / 1024,
              set.times.warp_s / threads, set.times.compress_s / threads, set.times.write_s / threads, set.times.finish_s);
  return 0;
}
