#pragma once
/// A folder that goes away with the test, file helpers, and expect_usage_error: a refusal must name the file and the reason.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"
#include "graphics/raster/raster.h"
namespace venato::graphics::test {

struct TempFolder {
  std::filesystem::path path;
  TempFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path = std::filesystem::temp_directory_path() / (std::string("venato_gfx_") + info->name() + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path);
  }
  ~TempFolder() { std::filesystem::remove_all(path); }
  std::filesystem::path operator/(const std::string& name) const { return path / name; }
  std::size_t entries() const { return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path), {})); }
};
inline std::string slurp(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void spill(const std::filesystem::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

template <class Work>
void expect_usage_error(const Work& work, const std::filesystem::path& file, const std::string& reason) {
  try {
    work();
    ADD_FAILURE() << "accepted: " << file;
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(reason), std::string::npos) << "wanted '" << reason << "' in: " << e.what();
  }
}
/// Smooth and textured channels with every byte value; different per channel.
inline Raster8 test_pattern(int width, int height, int channels, double pitch_m = 1e-3) {
  Raster8 r(width, height, channels, pitch_m);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      for (int c = 0; c < channels; ++c) r.at(i, j, c) = static_cast<std::uint8_t>((i * (c + 1) + j * 3 + (i * j) / 7 + 40 * c) & 0xff);
  return r;
}
}  // namespace venato::graphics::test
