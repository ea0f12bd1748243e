#include "graphics/tiff/tiff_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "tests/graphics/support.h"
namespace venato::graphics {
namespace {
using namespace test;
constexpr TiffCompression kAll[] = {TiffCompression::none, TiffCompression::packbits, TiffCompression::lzw, TiffCompression::deflate};

TiffInfo ink_info(int channels) {
  TiffInfo info;
  info.kind = TiffKind::separated;
  for (int c = 0; c < channels; ++c) info.ink_names.push_back("ink " + std::to_string(c));
  info.dpi = 360;
  info.description = R"({"frame":"print"})";
  return info;
}
std::span<const std::uint8_t> bytes_of(const Raster8& r) { return r.data; }

TEST(TiffFile, EveryChannelCountSizeAndCompressionComesBack) {
  const TempFolder folder;
  const auto file = folder / "a.tif";
  for (const auto& [w, h] : {std::pair{1, 1}, {1, 300}, {257, 1}, {131, 67}, {64, 128}, {63, 65}})
    for (int channels = 1; channels <= 8; ++channels)
      for (const auto compression : kAll) {
        const Raster8 image = test_pattern(w, h, channels);
        TiffInfo info = ink_info(channels);
        info.compression = compression;
        write_tiff(file, image, info, 2);
        const Raster8 back = read_tiff8(file);
        ASSERT_EQ(back.width, w);
        ASSERT_EQ(back.height, h);
        ASSERT_EQ(back.channels, channels);
        ASSERT_EQ(back.data, image.data) << w << "x" << h << "x" << channels << " compression " << static_cast<int>(compression);
      }
  EXPECT_EQ(folder.entries(), 1u);  // no partial file left
}

TEST(TiffFile, InfoComesBack) {
  const TempFolder folder;
  for (const bool big : {false, true}) {
    const auto file = folder / "a.tif";
    TiffInfo info = ink_info(6);
    info.big_tiff = big;
    info.no_ink_value = 255;
    info.software = "venato 1";
    info.compression = TiffCompression::lzw;
    write_tiff(file, test_pattern(100, 200, 6), info, 1);
    const TiffInfo back = read_tiff_info(file);
    EXPECT_EQ(back.width, 100);
    EXPECT_EQ(back.height, 200);
    EXPECT_EQ(back.channels, 6);
    EXPECT_EQ(back.bits, 8);
    EXPECT_EQ(back.kind, TiffKind::separated);
    EXPECT_EQ(back.compression, TiffCompression::lzw);
    EXPECT_EQ(back.rows_per_strip, 64);
    EXPECT_EQ(back.ink_names, info.ink_names);
    EXPECT_EQ(back.description, info.description);
    EXPECT_EQ(back.software, "venato 1");
    EXPECT_EQ(back.big_tiff, big);
    EXPECT_EQ(back.no_ink_value, 255);
    EXPECT_DOUBLE_EQ(back.dpi, 360);
    // The standard's magic: 42 classic, 43 BigTIFF.
    EXPECT_EQ(slurp(file)[2], big ? 43 : 42);
  }
}

TEST(TiffFile, PitchComesFromDpi) {
  const TempFolder folder;
  for (const double pitch : {1e-3, 0.5e-3, 0.0254 / 360}) {
    TiffInfo info;
    write_tiff(folder / "a.tif", test_pattern(5, 5, 1, pitch), info, 1);
    // TIFF stores the resolution as a ratio of 32-bit integers read back as float: 24 bit, 6e-8.
    EXPECT_NEAR(read_tiff8(folder / "a.tif").pitch_m / pitch, 1, 2e-7);
  }
  write_tiff(folder / "none.tif", test_pattern(5, 5, 1, 0), TiffInfo{}, 1);
  EXPECT_EQ(read_tiff8(folder / "none.tif").pitch_m, 0);
}

TEST(TiffFile, FloatFractionsAreExact) {
  const TempFolder folder;
  for (const auto compression : kAll)
    for (const int channels : {1, 2, 3}) {
      RasterF image(77, 130, channels, 1e-3);
      for (std::size_t k = 0; k < image.data.size(); ++k) image.data[k] = static_cast<float>(k) / 3000.0f - 0.1f;
      TiffInfo info;
      info.compression = compression;
      write_tiff(folder / "f.tif", image, info, 2);
      const RasterF back = read_tiff_f32(folder / "f.tif");
      EXPECT_EQ(back.channels, channels);
      EXPECT_EQ(back.data, image.data);
      EXPECT_EQ(read_tiff_info(folder / "f.tif").kind, TiffKind::fractions_f32);
    }
}

TEST(TiffFile, SameBytesForAnyThreadsAndChunks) {
  const TempFolder folder;
  const Raster8 image = test_pattern(201, 1003, 6);
  for (const auto compression : kAll) {
    std::string first;
    for (const int threads : {1, 2, 3, 7})
      for (const int chunk : {1, 63, 64, 100, 511, 1003}) {
        TiffInfo info = ink_info(6);
        info.width = image.width;
        info.height = image.height;
        info.channels = 6;
        info.compression = compression;
        TiffStripWriter writer(folder / "c.tif", info, threads);
        for (int j = 0; j < image.height; j += chunk)
          writer.write_rows(bytes_of(image).subspan(image.index(0, j), static_cast<std::size_t>(std::min(chunk, image.height - j)) * 201 * 6));
        writer.close();
        const std::string bytes = slurp(folder / "c.tif");
        if (first.empty()) first = bytes;
        ASSERT_TRUE(bytes == first) << threads << " threads, chunks of " << chunk;
      }
    EXPECT_EQ(read_tiff8(folder / "c.tif").data, image.data);
  }
}

TEST(TiffFile, CompressionCompresses) {
  const TempFolder folder;
  Raster8 image(512, 512, 6, 1e-3);
  for (int j = 0; j < 512; ++j)
    for (int i = 0; i < 512 * 6; ++i)
      image.data[image.index(0, j) + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>((i / 48 + j / 4) & 0xff);
  for (const auto compression : {TiffCompression::lzw, TiffCompression::deflate}) {
    TiffInfo info = ink_info(6);
    info.compression = compression;
    write_tiff(folder / "s.tif", image, info, 1);
    // Differences of a slow ramp are mostly 0; without the predictor either coder stays below 10 : 1 here.
    EXPECT_LT(static_cast<double>(std::filesystem::file_size(folder / "s.tif")), static_cast<double>(image.data.size()) / 10);
  }
}

TEST(TiffFile, UnfinishedFileLeavesNothing) {
  const TempFolder folder;
  spill(folder / "a.tif", "old content");
  {
    TiffInfo info;
    info.width = 100;
    info.height = 1000;
    TiffStripWriter writer(folder / "a.tif", info, 1);
    writer.write_rows(std::vector<std::uint8_t>(100 * 500, 7));
    EXPECT_EQ(folder.entries(), 2u);  // the partial file beside the old one
  }
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_EQ(slurp(folder / "a.tif"), "old content");
}

TEST(TiffFile, UnwritableFolderIsAWorkError) {
  TiffInfo info;
  info.width = info.height = 1;
  EXPECT_THROW(TiffStripWriter("/nonexistent-folder/a.tif", info, 1), WorkError);
}

TEST(TiffFile, FullDiskIsAWorkErrorAndLeavesNothing) {
  const TempFolder folder;
  // A file-size limit makes write() fail as a full disk does.
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100000, old.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  TiffInfo info;
  info.compression = TiffCompression::none;
  std::string message;
  try {
    write_tiff(folder / "full.tif", Raster8(1000, 1000, 1, 1e-3), info, 2);
  } catch (const WorkError& e) {
    message = e.what();
  }
  setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_NE(message.find("full.tif"), std::string::npos) << message;
  EXPECT_NE(message.find("too large"), std::string::npos) << message;  // strerror(EFBIG); ENOSPC would say "No space left"
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(TiffFile, TiffinfoReadsItWithoutWarnings) {
  if (std::system("command -v tiffinfo >/dev/null 2>&1") != 0) GTEST_SKIP() << "tiffinfo (libtiff-tools) is not installed";
  const TempFolder folder;
  for (const int channels : {1, 3, 4, 6, 8})
    for (const bool big : {false, true}) {
      TiffInfo info = ink_info(channels);
      info.big_tiff = big;
      write_tiff(folder / "t.tif", test_pattern(100, 100, channels), info, 1);
      const std::string command =
          "tiffinfo -s " + (folder / "t.tif").string() + " > " + (folder / "out").string() + " 2> " + (folder / "err").string();
      ASSERT_EQ(std::system(command.c_str()), 0);
      EXPECT_EQ(slurp(folder / "err"), "");
      const std::string out = slurp(folder / "out");
      EXPECT_EQ(out.find("arning"), std::string::npos) << out;
      EXPECT_NE(out.find("InkSet: 2"), std::string::npos) << out;
      EXPECT_NE(out.find("Resolution: 360, 360 pixels/inch"), std::string::npos) << out;
      for (const auto& name : info.ink_names) EXPECT_NE(out.find(name), std::string::npos) << out;
      EXPECT_EQ(out.find("Date"), std::string::npos) << out;
      EXPECT_EQ(out.find("Extra Samples: " + std::to_string(channels - 4)) != std::string::npos, channels > 4) << out;
    }
  for (const auto kind : {TiffKind::grey, TiffKind::rgb, TiffKind::fractions_f32}) {
    TiffInfo info;
    info.kind = kind;
    if (kind == TiffKind::fractions_f32)
      write_tiff(folder / "t.tif", RasterF(10, 10, 3, 1e-3), info, 1);
    else
      write_tiff(folder / "t.tif", test_pattern(10, 10, 3), info, 1);
    ASSERT_EQ(std::system(("tiffinfo -D " + (folder / "t.tif").string() + " > /dev/null 2> " + (folder / "err").string()).c_str()), 0);
    EXPECT_EQ(slurp(folder / "err"), "");
  }
}
}  // namespace
}  // namespace venato::graphics
