#include <gtest/gtest.h>

#include <chrono>

#include "graphics/tiff/tiff_file.h"
#include "tests/graphics/support.h"
namespace venato::graphics {
namespace {
using namespace test;

void append16(std::string& s, unsigned v) { s.push_back(static_cast<char>(v & 255)), s.push_back(static_cast<char>(v >> 8 & 255)); }
void append32(std::string& s, unsigned v) { append16(s, v & 0xffff), append16(s, v >> 16); }

/// Smallest little-endian TIFF: one strip, tags as given.
std::string tiny_tiff(unsigned width, unsigned height, unsigned channels, unsigned rows_per_strip, unsigned strip_offset, unsigned strip_bytes,
                      unsigned compression) {
  std::string s = "II";
  append16(s, 42);
  append32(s, 8);
  const unsigned tags[][2] = {{256, width},    {257, height},         {258, 8},          {259, compression}, {262, 1}, {273, strip_offset},
                              {277, channels}, {278, rows_per_strip}, {279, strip_bytes}};
  append16(s, std::size(tags));
  for (const auto& t : tags) {
    append16(s, t[0]);
    append16(s, 4);  // LONG
    append32(s, 1);
    append32(s, t[1]);
  }
  append32(s, 0);
  s.append(64, 'x');
  return s;
}

TEST(TiffHostile, GiantHeaderIsRefusedAtOnce) {
  const TempFolder folder;
  const auto file = folder / "giant.tif";
  for (const unsigned compression : {1u, 5u, 8u}) {
    spill(file, tiny_tiff(1000000, 1000000, 1, 1000000, 122, 64, compression));
    const auto start = std::chrono::steady_clock::now();
    expect_usage_error([&] { read_tiff8(file); }, file, "");
    expect_usage_error([&] { read_tiff_info(file); }, file, "1000000 x 1000000");
    // Allocating or touching even 4 GB takes longer than this on any machine.
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0.5);
  }
}

TEST(TiffHostile, MoreThanTheLimitIsRefused) {
  const TempFolder folder;
  const auto file = folder / "a.tif";
  write_tiff(file, test_pattern(100, 100, 3), TiffInfo{}, 1);
  EXPECT_NO_THROW(read_tiff8(file, 30000));
  expect_usage_error([&] { read_tiff8(file, 29999); }, file, "limit");
}

TEST(TiffHostile, FewBytesThatClaimGigabytesAreRefused) {
  const TempFolder folder;
  const auto file = folder / "bomb.tif";
  spill(file, tiny_tiff(60000, 60000, 1, 60000, 122, 64, 8));  // 3.6 GB, below the limit of 4 GB
  expect_usage_error([&] { read_tiff8(file); }, file, "more pixels than its data can hold");
  spill(file, tiny_tiff(8, 9, 1, 9, 122, 64, 1));  // 72 pixels, 64 bytes
  expect_usage_error([&] { read_tiff8(file); }, file, "truncated");
  spill(file, tiny_tiff(8, 8, 1, 8, 122, 64, 1));  // the honest neighbour is read
  EXPECT_EQ(read_tiff8(file).data, std::vector<std::uint8_t>(64, 'x'));
}

TEST(TiffHostile, EveryTruncationIsRefused) {
  const TempFolder folder;
  const auto file = folder / "cut.tif";
  for (const auto compression : {TiffCompression::none, TiffCompression::lzw, TiffCompression::deflate}) {
    TiffInfo info;
    info.compression = compression;
    write_tiff(folder / "whole.tif", test_pattern(150, 200, 1), info, 1);
    const std::string bytes = slurp(folder / "whole.tif");
    for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 97) {
      spill(file, bytes.substr(0, n));
      SCOPED_TRACE(std::to_string(n) + " of " + std::to_string(bytes.size()));
      expect_usage_error([&] { read_tiff8(file); }, file, n == 0 ? "0 bytes" : "");
    }
  }
}

TEST(TiffHostile, DirectoryBeforeCutDataIsTruncated) {
  const TempFolder folder;
  const auto file = folder / "cut.tif";
  spill(file, tiny_tiff(8, 8, 1, 8, 122, 64, 1).substr(0, 150));  // directory whole, data cut
  expect_usage_error([&] { read_tiff8(file); }, file, "truncated");
}

TEST(TiffHostile, CorruptCompressedDataAreRefused) {
  const TempFolder folder;
  const auto file = folder / "corrupt.tif";
  spill(file, tiny_tiff(8, 8, 1, 8, 122, 64, 8));  // 'xxxx' is no zlib stream
  expect_usage_error([&] { read_tiff8(file); }, file, "corrupt");
}

TEST(TiffHostile, FlippedBytesNeverCrash) {
  const TempFolder folder;
  const auto file = folder / "flip.tif";
  TiffInfo info;
  info.kind = TiffKind::separated;
  info.ink_names = {"a", "b", "c", "d", "e", "f"};
  write_tiff(folder / "whole.tif", test_pattern(40, 70, 6), info, 1);
  const std::string bytes = slurp(folder / "whole.tif");
  int refused = 0;
  for (std::size_t at = 0; at < bytes.size(); at += at < bytes.size() - 600 ? 37 : 1) {  // the directory, at the end, densely
    std::string bad = bytes;
    bad[at] = static_cast<char>(bad[at] ^ (at % 2 ? 0xff : 0x11));
    spill(file, bad);
    try {
      read_tiff_info(file);
      read_tiff8(file);
    } catch (const UsageError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);  // many flips hit pixel values only and are rightly read
}

TEST(TiffHostile, WrongKindOfFileIsRefused) {
  const TempFolder folder;
  expect_usage_error([&] { read_tiff8(folder / "missing.tif"); }, folder / "missing.tif", "no such file");
  spill(folder / "empty.tif", "");
  expect_usage_error([&] { read_tiff8(folder / "empty.tif"); }, folder / "empty.tif", "0 bytes");
  spill(folder / "text.tif", "this is not a TIFF at all");
  expect_usage_error([&] { read_tiff8(folder / "text.tif"); }, folder / "text.tif", "cannot be read as TIFF");
  expect_usage_error([&] { read_tiff8(folder.path); }, folder.path, "regular file");
  write_tiff(folder / "f.tif", RasterF(3, 3, 1, 1e-3), TiffInfo{}, 1);
  expect_usage_error([&] { read_tiff8(folder / "f.tif"); }, folder / "f.tif", "32 bit float");
  write_tiff(folder / "8.tif", Raster8(3, 3, 1, 1e-3), TiffInfo{}, 1);
  expect_usage_error([&] { read_tiff_f32(folder / "8.tif"); }, folder / "8.tif", "8 bit integer");
}
}  // namespace
}  // namespace venato::graphics
