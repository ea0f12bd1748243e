#include "graphics/tiff/ink_picture.h"

#include "graphics/tiff/tiff_file.h"
#include "tests/graphics/support.h"
namespace venato::graphics {
namespace {

class InkPicture : public testing::Test {
 protected:
  /// 3 x 2 px, sample = 10 * pixel + channel.
  std::filesystem::path write(const std::string& name, std::vector<std::string> names, std::uint8_t no_ink = 0, TiffKind kind = TiffKind::separated) {
    Raster8 image(3, 2, static_cast<int>(names.size()), 0.001);
    for (std::size_t k = 0; k < image.data.size(); ++k) image.data[k] = static_cast<std::uint8_t>(10 * (k / names.size()) + k % names.size());
    TiffInfo info;
    info.kind = kind;
    info.ink_names = kind == TiffKind::separated ? names : std::vector<std::string>{};
    info.no_ink_value = no_ink;
    write_tiff(folder / name, image, info, 1);
    return folder / name;
  }
  test::TempFolder folder;
};

TEST_F(InkPicture, AmountsNamesAndSizeAreThoseOfTheFile) {
  const auto file = write("a.tif", {"Blue", "Brown", "Pink", "Black", "White"});
  EXPECT_TRUE(is_separated_tiff(file));
  const auto info = read_ink_picture_info(file);
  EXPECT_EQ(info.width, 3);
  EXPECT_EQ(info.height, 2);
  EXPECT_EQ(info.inks, 5);
  EXPECT_NEAR(info.dpi, 25.4, 1e-3);
  EXPECT_EQ(info.names, (std::vector<std::string>{"Blue", "Brown", "Pink", "Black", "White"}));
  const auto ink = read_ink_picture(file);
  EXPECT_EQ(ink.at(2, 1, 3), 53);
  EXPECT_EQ(ink.at(0, 0, 0), 0);
}

TEST_F(InkPicture, AFileWhoseZeroIsFullInkIsInverted) {
  const auto ink = read_ink_picture(write("a.tif", {"Blue", "Brown", "Pink", "Black"}, 255));
  EXPECT_EQ(ink.at(2, 1, 3), 255 - 53);
}

TEST_F(InkPicture, WhatIsNotASeparatedTiffIsToldApart) {
  EXPECT_FALSE(is_separated_tiff(write("rgb.tif", {"r", "g", "b"}, 0, TiffKind::rgb)));
  EXPECT_FALSE(is_separated_tiff(folder / "missing.tif"));
  std::ofstream(folder / "short.tif") << "II*";
  EXPECT_FALSE(is_separated_tiff(folder / "short.tif"));
  std::ofstream(folder / "lie.tif") << std::string("II*\0\xff\xff\xff\x7f", 8);
  EXPECT_FALSE(is_separated_tiff(folder / "lie.tif"));
  test::expect_usage_error([&] { read_ink_picture_info(folder / "rgb.tif"); }, folder / "rgb.tif", "not a separated TIFF");
  test::expect_usage_error([&] { read_ink_picture(write("b.tif", {"a", "b"}), 5); }, folder / "b.tif", "3 x 2 px");
}
}  // namespace
}  // namespace venato::graphics
