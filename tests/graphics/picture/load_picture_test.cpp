#include <gtest/gtest.h>

#include <chrono>
#include <opencv2/imgcodecs.hpp>

#include "graphics/graphic.h"
#include "graphics/picture/picture_header.h"
#include "graphics/tiff/tiff_file.h"
#include "tests/graphics/support.h"
namespace venato::graphics {
namespace {
using namespace test;

std::string big32(std::uint32_t v) {
  return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
}
std::string chunk(const std::string& type, const std::string& body) {
  return big32(static_cast<std::uint32_t>(body.size())) + type + body + big32(png_crc(type + body));
}
const std::string kPng("\x89PNG\r\n\x1a\n", 8);
std::string ihdr(std::uint32_t w, std::uint32_t h) { return chunk("IHDR", big32(w) + big32(h) + std::string("\x08\x00\x00\x00\x00", 5)); }

TEST(LoadPicture, PngComesBackExactlyWithItsPitch) {
  const TempFolder folder;
  for (const int channels : {1, 3}) {
    const Raster8 image = test_pattern(61, 40, channels, 0.5e-3), before = image;
    write_png(folder / "a.png", image);
    EXPECT_EQ(image.data, before.data);
    const Picture p = load_picture(folder / "a.png", std::nullopt);
    EXPECT_TRUE(p.pitch_from_file);
    EXPECT_NEAR(p.pixels.pitch_m, 0.5e-3, 1e-12);  // 2000 px/m is a whole number
    EXPECT_EQ(p.pixels.channels, channels);
    EXPECT_EQ(p.pixels.data, image.data);
    const Picture q = load_picture(folder / "a.png", 2e-3);
    EXPECT_FALSE(q.pitch_from_file);
    EXPECT_EQ(q.pixels.pitch_m, 2e-3);
  }
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(LoadPicture, JpegDensityAndColourOrder) {
  const TempFolder folder;
  Raster8 red(64, 64, 3, 1e-3);
  for (std::size_t k = 0; k < red.data.size(); k += 3) red.data[k] = 200;
  spill(folder / "a.jpg", encode_jpeg(red, 95));
  const Picture p = load_picture(folder / "a.jpg", std::nullopt);
  EXPECT_NEAR(p.pixels.pitch_m, 1e-3, 1e-9);    // 10 dots per cm is exact
  EXPECT_NEAR(p.pixels.at(32, 32, 0), 200, 3);  // JPEG rounding
  EXPECT_NEAR(p.pixels.at(32, 32, 2), 0, 3);
  red.pitch_m = 0.0254 / 360;
  spill(folder / "b.jpg", encode_jpeg(red, 95));
  EXPECT_NEAR(load_picture(folder / "b.jpg", std::nullopt).pixels.pitch_m * 360 / 0.0254, 1, 1e-9);
}

TEST(LoadPicture, TiffGreyRgbAnd16Bit) {
  const TempFolder folder;
  for (const int channels : {1, 3}) {
    TiffInfo info;
    info.kind = channels == 3 ? TiffKind::rgb : TiffKind::grey;
    const Raster8 image = test_pattern(33, 70, channels, 0.25e-3);
    write_tiff(folder / "a.tif", image, info, 1);
    const Picture p = load_picture(folder / "a.tif", std::nullopt);
    EXPECT_EQ(p.pixels.data, image.data);
    EXPECT_NEAR(p.pixels.pitch_m / 0.25e-3, 1, 2e-7);  // float in the tag
  }
  cv::Mat deep(10, 10, CV_16UC3, cv::Scalar(257 * 10, 257 * 20, 257 * 30));  // B, G, R
  cv::imwrite((folder / "deep.tif").string(), deep);
  cv::imwrite((folder / "deep.png").string(), deep);
  for (const char* name : {"deep.tif", "deep.png"}) {
    const Picture p = load_picture(folder / name, 1e-3);
    ASSERT_EQ(p.pixels.channels, 3) << name;
    EXPECT_EQ(p.pixels.at(5, 5, 0), 30) << name;
    EXPECT_EQ(p.pixels.at(5, 5, 2), 10) << name;
  }
}

TEST(LoadPicture, AlphaIsComposedOnWhite) {
  const TempFolder folder;
  cv::Mat m(4, 4, CV_8UC4, cv::Scalar(0, 100, 200, 0));
  m.at<cv::Vec4b>(0, 1)[3] = 255;
  m.at<cv::Vec4b>(0, 2)[3] = 51;  // 20 %
  cv::imwrite((folder / "a.png").string(), m);
  const Raster8 p = load_picture(folder / "a.png", 1e-3).pixels;
  ASSERT_EQ(p.channels, 3);
  EXPECT_EQ(p.at(0, 0, 1), 255);
  EXPECT_EQ(p.at(1, 0, 0), 200);
  EXPECT_EQ(p.at(1, 0, 2), 0);
  EXPECT_EQ(p.at(2, 0, 2), 204);  // 0.8 * 255
}

TEST(LoadPicture, NotAPicture) {
  const TempFolder folder;
  expect_usage_error([&] { load_picture(folder / "no.png", 1e-3); }, folder / "no.png", "no such file");
  for (const char* name : {"a.png", "a.jpg", "a.tif"}) {
    spill(folder / name, "");
    expect_usage_error([&] { load_picture(folder / name, 1e-3); }, folder / name, "0 bytes");
    spill(folder / name, "<svg>hello</svg>");
    expect_usage_error([&] { load_picture(folder / name, 1e-3); }, folder / name, "not a PNG, JPEG or TIFF");
  }
  expect_usage_error([&] { load_picture(folder.path, 1e-3); }, folder.path, "regular file");
}

TEST(LoadPicture, NoPitchSaysWhatToGive) {
  const TempFolder folder;
  write_png(folder / "a.png", test_pattern(8, 8, 1, 0));
  expect_usage_error([&] { load_picture(folder / "a.png", std::nullopt); }, folder / "a.png", "no dpi");
  write_tiff(folder / "a.tif", test_pattern(8, 8, 1, 0), TiffInfo{}, 1);
  expect_usage_error([&] { load_picture(folder / "a.tif", std::nullopt); }, folder / "a.tif", "no dpi");
  std::string png = kPng + ihdr(8, 8) + chunk("pHYs", big32(1000) + big32(2000) + "\x01");
  png += slurp(folder / "a.png").substr(33);  // the data of the real one
  spill(folder / "b.png", png);
  expect_usage_error([&] { load_picture(folder / "b.png", std::nullopt); }, folder / "b.png", "not square");
  EXPECT_THROW(load_picture(folder / "a.png", -1.0), UsageError);
}

TEST(LoadPicture, EveryTruncationIsRefused) {
  const TempFolder folder;
  const Raster8 image = test_pattern(200, 150, 3);
  TiffInfo info;
  info.kind = TiffKind::rgb;
  write_tiff(folder / "w.tif", image, info, 1);
  const std::pair<std::string, std::string> files[] = {
      {"c.png", encode_png(image)}, {"c.jpg", encode_jpeg(image, 90)}, {"c.tif", slurp(folder / "w.tif")}};
  for (const auto& [name, bytes] : files) {
    spill(folder / name, bytes);
    EXPECT_NO_THROW(load_picture(folder / name, 1e-3)) << name;
    // Not the very last bytes of a JPEG or PNG only: every length down to nothing.
    for (std::size_t n = bytes.size() - 1; n > 0; n -= std::min(n, 1 + bytes.size() / 60)) {
      spill(folder / name, bytes.substr(0, n));
      expect_usage_error([&] { load_picture(folder / name, 1e-3); }, folder / name, "");
    }
  }
}

TEST(LoadPicture, TooLargeIsRefusedFromTheHeader) {
  const TempFolder folder;
  // Whole PNG by its structure, with a claim of 10^10 pixels and nothing in it.
  spill(folder / "big.png", kPng + ihdr(100000, 100000) + chunk("IDAT", "x") + chunk("IEND", ""));
  expect_usage_error([&] { load_picture(folder / "big.png", 1e-3); }, folder / "big.png", "limit 250 Mpx");
  std::string jpeg = encode_jpeg(test_pattern(16, 16, 1), 90);
  const std::size_t sof = jpeg.find("\xff\xc0");
  ASSERT_NE(sof, std::string::npos);
  for (std::size_t k = 5; k < 9; ++k) jpeg[sof + k] = '\xff';  // 65535 x 65535
  spill(folder / "big.jpg", jpeg);
  expect_usage_error([&] { load_picture(folder / "big.jpg", 1e-3); }, folder / "big.jpg", "limit 250 Mpx");
  write_tiff(folder / "a.tif", test_pattern(100, 100, 1), TiffInfo{}, 1);
  expect_usage_error([&] { load_picture(folder / "a.tif", 1e-3, 9999); }, folder / "a.tif", "limit");
  EXPECT_NO_THROW(load_picture(folder / "a.tif", 1e-3, 10000));
}

TEST(LoadPicture, HundredKilobytesThatClaimAMillionByAMillionPixelsAreRefusedAtOnce) {
  const TempFolder folder;
  const auto refused_at_once = [&](const std::string& name, std::string bytes, const std::string& reason, double max_pixels) {
    spill(folder / name, bytes);
    const auto start = std::chrono::steady_clock::now();
    expect_usage_error([&] { load_picture(folder / name, 1e-3, max_pixels); }, folder / name, reason);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0.5);  // touching 10^12 px takes minutes
  };
  const std::string filler(100000, 'x');
  const std::string png = kPng + ihdr(1000000, 1000000) + chunk("IDAT", filler) + chunk("IEND", "");
  // JPEG sizes end at 65535: SOI, frame header, scan header, data, EOI.
  const std::string jpeg = std::string("\xff\xd8\xff\xc0\x00\x0b\x08\xff\xff\xff\xff\x01\x01\x11\x00", 15) +
                           std::string("\xff\xda\x00\x08\x01\x01\x00\x00\x3f\x00", 10) + filler + "\xff\xd9";
  // Little-endian TIFF, one strip of 100 kB.
  std::string tiff("II\x2a\x00\x08\x00\x00\x00\x09\x00", 10);
  const std::uint32_t tags[][2] = {{256, 1000000}, {257, 1000000}, {258, 8}, {259, 8}, {262, 1}, {273, 122}, {277, 1}, {278, 1000000}, {279, 100000}};
  for (const auto& tag : tags)
    for (const std::uint32_t word : {tag[0] | 4u << 16, 1u, tag[1]})
      for (int k = 0; k < 4; ++k) tiff += static_cast<char>(word >> 8 * k);
  tiff += std::string(4, '\0') + filler;
  for (const double limit : {2.5e8, 1e18}) {  // also when the caller would take any size
    refused_at_once("a.png", png, "1000000 x 1000000 px", limit);
    refused_at_once("a.jpg", jpeg, "65535 x 65535 px", limit);
    refused_at_once("a.tif", tiff, "1000000 x 1000000 px", limit);
  }
}

TEST(LoadPicture, CorruptPngIsRefused) {
  const TempFolder folder;
  const std::string png = encode_png(test_pattern(50, 50, 3));
  std::string flipped = png;
  flipped[png.size() / 2] = static_cast<char>(flipped[png.size() / 2] ^ 0x10);
  spill(folder / "a.png", flipped);
  expect_usage_error([&] { load_picture(folder / "a.png", 1e-3); }, folder / "a.png", "checksum");
  spill(folder / "a.png", kPng + ihdr(50, 50) + chunk("IDAT", "this is no zlib stream") + chunk("IEND", ""));  // checksums right, content not
  expect_usage_error([&] { load_picture(folder / "a.png", 1e-3); }, folder / "a.png", "corrupt");
  spill(folder / "a.png", kPng + ihdr(0, 50) + chunk("IDAT", "x") + chunk("IEND", ""));
  expect_usage_error([&] { load_picture(folder / "a.png", 1e-3); }, folder / "a.png", "bad size");
}

TEST(LoadPicture, SeparatedAndFloatTiffAreNoPictures) {
  const TempFolder folder;
  TiffInfo info;
  info.kind = TiffKind::separated;
  info.ink_names = {"a", "b", "c", "d", "e", "f"};
  write_tiff(folder / "inks.tif", test_pattern(9, 9, 6), info, 1);
  expect_usage_error([&] { load_picture(folder / "inks.tif", 1e-3); }, folder / "inks.tif", "6 inks");
  write_tiff(folder / "f.tif", RasterF(9, 9, 1, 1e-3), TiffInfo{}, 1);
  expect_usage_error([&] { load_picture(folder / "f.tif", 1e-3); }, folder / "f.tif", "float");
}

TEST(LoadPicture, ExamplePicturesLoad) {
  for (const char* name : {"pov_calacatta_1600x3200.jpg", "pov_arabescato_1600x3200.jpg"}) {
    const auto file = std::filesystem::path(VENATO_SOURCE_DIR) / "configs/images" / name;
    const Picture p = load_picture(file, 1e-3);
    EXPECT_EQ(p.pixels.width, 1600);
    EXPECT_EQ(p.pixels.height, 3200);
    EXPECT_EQ(p.pixels.channels, 3);
    EXPECT_THROW(load_picture(file, std::nullopt), UsageError);  // they carry no dpi
  }
}

TEST(WritePng, UnwritableFolderIsAWorkError) { EXPECT_THROW(write_png("/nonexistent-folder/a.png", Raster8(2, 2, 1, 1e-3)), WorkError); }
}  // namespace
}  // namespace venato::graphics
