// The printer files through other people's programs: every pixel of every file as we meant it. ./check installs them; a missing one fails its test.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "graphics/graphic.h"
#include "sync/mask/mask_job.h"
#include "tests/sync/mask/mask_fixture.h"

namespace venato::sync {
namespace {
namespace fs = std::filesystem;

bool installed(const std::string& program) { return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0; }
#define NEEDS(program, package) \
  ASSERT_TRUE(installed(program)) << program " (Debian: " package ") is not installed: nothing was checked with it"

std::string text(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// Files of 6 inks (more than four: ExtraSamples) in a compression, and the pixels that they must hold.
class ReadBack : public ::testing::TestWithParam<graphics::TiffCompression> {
 protected:
  void SetUp() override {
    job_ = test::small_job();
    job_.compression = GetParam();
    set_ = write_masks(job_, out_.path, t_.context);
    truth_ = test::warp_all(job_.layers[0].ink, job_.print_from_green, {set_.width_px, set_.height_px, set_.pitch_m}, 64, 1);
  }
  fs::path file(const std::string& name) const { return out_.path / name; }
  fs::path scratch(const std::string& name) const { return t_.folder.path / name; }
  /// Exit code 0 and not a word on stderr.
  void run(const std::string& command) const {
    ASSERT_EQ(std::system((command + " >" + scratch("out").string() + " 2>" + scratch("err").string()).c_str()), 0) << command << "\n"
                                                                                                                    << test::bytes_of(scratch("err"));
    EXPECT_EQ(test::bytes_of(scratch("err")), "") << command;
  }
  std::string ink(std::size_t c) const {  // as its grey file holds it: 0 = full ink
    std::string plane;
    for (std::size_t k = c; k < truth_.size(); k += job_.inks.size()) plane += static_cast<char>(255 - truth_[k]);
    return plane;
  }
  test::TestContext t_;
  test::TempFolder out_;
  MaskJob job_;
  MaskSet set_;
  std::vector<std::uint8_t> truth_;
};

TEST_P(ReadBack, Tiffinfo) {
  NEEDS("tiffinfo", "libtiff-tools");
  for (const auto& f : set_.files)
    if (file(f.name).extension() == ".tif") run("tiffinfo -D " + file(f.name).string());
  run("tiffinfo " + file("print.tif").string());
  const std::string told = test::bytes_of(scratch("out"));
  for (const char* part : {"Photometric Interpretation: separated", "InkSet: 2", "Extra Samples: 2<unspecified, unspecified>", "blue", "black",
                           "Resolution: 360, 360 pixels/inch"})
    EXPECT_NE(told.find(part), std::string::npos) << part << "\n" << told;
}

TEST_P(ReadBack, Libvips) {
  NEEDS("vips", "libvips-tools");
  run("vips rawsave " + file("print.tif").string() + " " + scratch("print.raw").string());
  EXPECT_TRUE(test::bytes_of(scratch("print.raw")) == text(truth_));
  for (std::size_t c = 0; c < job_.inks.size(); ++c) {
    run("vips rawsave " + file("print_" + job_.inks[c].name + ".tif").string() + " " + scratch("ink.raw").string());
    EXPECT_TRUE(test::bytes_of(scratch("ink.raw")) == ink(c)) << job_.inks[c].name;
  }
}

TEST_P(ReadBack, Gdal) {
  NEEDS("gdal_translate", "gdal-bin");
  run("gdal_translate -q -of ENVI -co INTERLEAVE=BIP " + file("print.tif").string() + " " + scratch("print.raw").string());
  EXPECT_TRUE(test::bytes_of(scratch("print.raw")) == text(truth_));
  for (std::size_t c = 0; c < job_.inks.size(); ++c) {
    run("gdal_translate -q -of ENVI " + file("print_" + job_.inks[c].name + ".tif").string() + " " + scratch("ink.raw").string());
    EXPECT_TRUE(test::bytes_of(scratch("ink.raw")) == ink(c)) << job_.inks[c].name;
  }
}

TEST_P(ReadBack, ImageMagick) {  // version 6 sees five channels at most: the grey files and the preview
  NEEDS("convert", "imagemagick");
  for (std::size_t c = 0; c < job_.inks.size(); ++c) {
    run("convert " + file("print_" + job_.inks[c].name + ".tif").string() + " -depth 8 gray:" + scratch("ink.raw").string());
    EXPECT_TRUE(test::bytes_of(scratch("ink.raw")) == ink(c)) << job_.inks[c].name;
  }
  run("convert " + file("preview.png").string() + " -depth 8 rgb:" + scratch("preview.raw").string());
  EXPECT_TRUE(test::bytes_of(scratch("preview.raw")) == text(graphics::load_picture(file("preview.png"), std::nullopt).pixels.data));
}

TEST_P(ReadBack, GhostscriptPrintsThePreview) {  // a PostScript page around it, rendered at its own resolution: the same pixels
  NEEDS("gs", "ghostscript");
  NEEDS("convert", "imagemagick");
  const auto picture = graphics::load_picture(file("preview.png"), std::nullopt).pixels;
  const std::string w = std::to_string(picture.width), h = std::to_string(picture.height);
  run("convert " + file("preview.png").string() + " -depth 8 rgb:" + scratch("preview.raw").string());
  std::ofstream page(scratch("page.ps"), std::ios::binary);
  page << "%!PS\n<< /PageSize [" << w << " " << h << "] >> setpagedevice\n/row 3 " << w << " mul string def\n"
       << w << " " << h << " scale " << w << " " << h << " 8 [" << w << " 0 0 -" << h << " 0 " << h
       << "] { currentfile row readhexstring pop } false 3 colorimage\n";
  constexpr char digits[] = "0123456789abcdef";
  for (const char c : test::bytes_of(scratch("preview.raw"))) page << digits[static_cast<unsigned char>(c) >> 4] << digits[c & 15];
  page << "\nshowpage\n";
  page.close();
  run("gs -q -dSAFER -dBATCH -dNOPAUSE -sDEVICE=ppmraw -r72 -sOutputFile=" + scratch("page.ppm").string() + " " + scratch("page.ps").string());
  run("convert " + scratch("page.ppm").string() + " -depth 8 rgb:" + scratch("page.raw").string());
  EXPECT_TRUE(test::bytes_of(scratch("page.raw")) == text(picture.data));
}

TEST_P(ReadBack, AWrongPixelIsSeen) {  // the comparison itself
  auto wrong = truth_;
  wrong[wrong.size() / 2] ^= 1;
  EXPECT_FALSE(text(wrong) == text(truth_));
  EXPECT_TRUE(graphics::read_tiff8(file("print.tif")).data == truth_);
}

INSTANTIATE_TEST_SUITE_P(Compressions, ReadBack, ::testing::Values(graphics::TiffCompression::deflate, graphics::TiffCompression::lzw));
}  // namespace
}  // namespace venato::sync
