#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "base/context.h"
#include "base/store/store.h"
#include "sync/mask/mask_job.h"
#include "tests/sync/warp/warp_fixture.h"

namespace venato::sync::test {
namespace fs = std::filesystem;

struct TempFolder {
  fs::path path;
  TempFolder() {
    std::string name = (fs::temp_directory_path() / "venato_mask_XXXXXX").string();
    path = ::mkdtemp(name.data());
  }
  ~TempFolder() {
    std::error_code ignored;
    fs::permissions(path, fs::perms::owner_all, ignored);
    fs::remove_all(path, ignored);
  }
};

/// A context that owns what it refers to.
struct TestContext {
  TempFolder folder;
  std::unique_ptr<Log> log = make_null_log();
  std::unique_ptr<Progress> progress = make_null_progress();
  Store store{folder.path / "store"};
  std::atomic<bool> stop{false};
  Context context{*log, *progress, store, 1, 2, &stop};
};

inline std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
/// Names and contents of all files below a folder, hidden ones too.
inline std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    out[fs::relative(entry.path(), folder).string()] = entry.is_regular_file() ? bytes_of(entry.path()) : "";
  return out;
}

/// Smooth ink amounts with dark bands: something like a graphic.
inline graphics::Raster8 bands(int width, int height, int inks, double pitch_m) {
  graphics::Raster8 image(width, height, inks, pitch_m);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      for (int c = 0; c < inks; ++c)
        image.at(i, j, c) = static_cast<std::uint8_t>(110 + 100 * std::sin(0.11 * i * (1 + 0.2 * c) + 0.07 * j) * std::cos(0.03 * j * (c + 1)));
  return image;
}

inline MaskJob small_job(int inks = 6) {
  MaskJob job;
  job.slab_id = "slab-42";
  job.run_id = "run-7";
  const char* names[] = {"blue", "brown", "beige", "yellow", "pink", "black", "white", "glue"};
  for (int k = 0; k < inks; ++k) job.inks.push_back({names[k], {static_cast<std::uint8_t>(20 * k), 90, static_cast<std::uint8_t>(200 - 20 * k)}});
  job.body_srgb = {240, 236, 228};
  job.width_m = 0.0423;
  job.height_m = 0.0317;
  job.dpi = 360;
  job.layers.push_back({"all", bands(180, 140, inks, 0.00025), true});
  job.print_from_green = bent(job.width_m, job.height_m, 0.011, 0.0008);
  job.print_from_green.t = Point(0.0005, 0.0007);
  job.pose_from_green = job.print_from_green;
  job.pose_from_green.u = {};
  PowderMask powder;
  powder.name = "grey";
  powder.fraction = graphics::RasterF(43, 32, 1, 0.001);
  for (std::size_t k = 0; k < powder.fraction.data.size(); ++k) powder.fraction.data[k] = static_cast<float>(k % 43) / 42.0f;
  job.powders.push_back(powder);
  FeedFile feed{"vein_grey", "grey", 4, 3, 0.005, 0.05, 0.1, 2.5, {0, 0.25, 1, 1, 0, 0, 0.5, 1, 0, 0, 0, 0.1}};
  job.feeds.push_back(feed);
  return job;
}
}  // namespace venato::sync::test
