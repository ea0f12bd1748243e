// The corpus of tests/fuzz and some thousand mutations of it, through every picture reader: the part of the fuzzing that each ./check repeats.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "graphics/graphic.h"
#include "graphics/tiff/tiff_file.h"
#include "tests/graphics/support.h"
namespace venato::graphics {
namespace {
using namespace test;
constexpr double kMaxPixels = 1 << 20, kMaxBytes = 4 << 20;

std::vector<std::filesystem::path> corpus() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(VENATO_SOURCE_DIR "/tests/fuzz/corpus")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Whether `work` succeeds; a refusal must name the file, anything but a UsageError fails the test by itself.
template <class Work>
bool succeeds(const Work& work, const std::filesystem::path& file) {
  try {
    work();
    return true;
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos) << e.what();
    return false;
  }
}
/// How many of the readers take the file.
int readers_of(const std::filesystem::path& file) {
  int n = succeeds([&] { load_picture(file, 1e-3, kMaxPixels); }, file);
  n += succeeds([&] { read_tiff_info(file); }, file);
  n += succeeds([&] { read_tiff8(file, kMaxBytes); }, file);
  n += succeeds([&] { read_tiff_f32(file, kMaxBytes); }, file);
  return n;
}

TEST(FuzzCorpus, EveryFileIsTakenByAReader) {
  ASSERT_GE(corpus().size(), 20u);
  for (const auto& file : corpus()) EXPECT_GT(readers_of(file), 0) << file;
}

TEST(FuzzCorpus, MutationsAreReadOrRefusedByName) {
  const TempFolder folder;
  const auto file = folder / "mutated";
  Rng rng(1, stream_id("test/graphics/fuzz_corpus"));
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(rng.below(static_cast<std::uint32_t>(n))); };
  int taken = 0, refused = 0;
  for (const auto& seed : corpus()) {
    const std::string whole = slurp(seed);
    for (int k = 0; k < 60; ++k) {
      std::string bytes = whole;
      for (std::size_t n = 1 + below(4); n > 0; --n) {
        const std::size_t at = below(bytes.size());
        switch (below(4)) {
          case 0:
            bytes[at] = static_cast<char>(below(256));
            break;
          case 1:
            bytes[at] = static_cast<char>(below(2) ? 0xff : 0x00);
            break;
          case 2:
            bytes.erase(at, 1 + below(8));
            break;
          default:
            bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(8)));
        }
        if (bytes.empty()) bytes = whole;
      }
      spill(file, bytes);
      ++(readers_of(file) > 0 ? taken : refused);
    }
  }
  EXPECT_GT(taken, 100);
  EXPECT_GT(refused, 100);
}
}  // namespace
}  // namespace venato::graphics
