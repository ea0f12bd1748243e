/// How the graphic gets its inks: separated TIFFs pass through, pictures go through the printer's profile.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "graphics/icc/separate_by_profile.h"
#include "graphics/tiff/tiff_file.h"
#include "line/chain/masks_of_run.h"
#include "line/chain/pictures.h"
#include "line/chain/run_line.h"
#include "tests/base/temp_folder.h"
#include "tests/graphics/icc/synthetic_profile.h"
#include "tests/line/support/fake_line.h"
namespace venato::line {
namespace {
using graphics::Raster8;
using Json = nlohmann::json;

class GraphicLayers : public ::testing::Test {
 protected:
  /// 120 x 220 px at 1 mm; any amounts that tell pixels and inks apart.
  Raster8 write_inks(const std::string& name, std::vector<std::string> names) {
    Raster8 ink(120, 220, static_cast<int>(names.size()), 0.001);
    for (std::size_t k = 0; k < ink.data.size(); ++k) ink.data[k] = static_cast<std::uint8_t>((k * 2654435761u) >> 24);
    graphics::TiffInfo info;
    info.kind = graphics::TiffKind::separated;
    info.ink_names = std::move(names);
    graphics::write_tiff(folder / name, ink, info, 1);
    return ink;
  }
  LineConfig config(const std::string& graphic) {
    return load_line_config_text(fake::config_text(), folder.path(), {{"/graphic", "{" + graphic + "}"}}, stages);
  }
  static std::string by_solids(const std::string& image, const std::string& inks) {
    return R"("image":")" + image + R"(","pitch_mm":1,"body_colour":"#f0f0f0","print_dpi":50,"inks":[)" + inks + "]";
  }
  static std::string ink(const std::string& name) { return R"({"name":")" + name + R"(","solid":"#203040"})"; }
  std::string issues(const LineConfig& c) {
    std::string out;
    for (const auto& issue : check_pictures(c)) out += format_issue(issue) + "\n";
    return out;
  }
  TempFolder folder;
  std::vector<StageDescriptor> stages = fake::stages();
};

TEST_F(GraphicLayers, InksOfASeparatedFilePassThroughUntouched) {
  const auto source = write_inks("g.tif", {"Blue", "Brown", "Black"});
  const auto c = config(by_solids("g.tif", ink("Blue") + "," + ink("Brown") + "," + ink("Black")));
  EXPECT_EQ(issues(c), "");
  const auto layers = load_graphic(c, 2);
  ASSERT_EQ(layers.size(), 1u);
  EXPECT_TRUE(layers[0].own_inks);
  EXPECT_FALSE(layers[0].inks.separated_without_profile);
  const auto& got = layers[0].inks.ink;
  ASSERT_EQ(got.channels, 3);
  EXPECT_EQ(got.width, 100);
  EXPECT_EQ(got.height, 200);
  int differ = 0;
  for (int j = 0; j < got.height; ++j)
    for (int i = 0; i < got.width; ++i)
      for (int k = 0; k < 3; ++k) differ += got.at(i, j, k) != source.at(i, j, k);
  EXPECT_EQ(differ, 0);
  EXPECT_EQ(layers[0].picture.channels, 3);
  EXPECT_EQ(layers[0].picture.width, got.width);
}

TEST_F(GraphicLayers, ChannelsGoByNameIntoThePrintersOrder) {
  const auto source = write_inks("g.tif", {"Black", "BLUE"});
  const auto layers = load_graphic(config(by_solids("g.tif", ink("blue") + "," + ink("black"))), 1);
  EXPECT_EQ(layers[0].inks.ink.at(7, 9, 0), source.at(7, 9, 1));
  EXPECT_EQ(layers[0].inks.ink.at(7, 9, 1), source.at(7, 9, 0));
}

TEST_F(GraphicLayers, OtherInksThanThePrintersAreRefusedWithBothLists) {
  write_inks("g.tif", {"Blue", "Black"});
  const auto names = issues(config(by_solids("g.tif", ink("blue") + "," + ink("pink"))));
  EXPECT_NE(names.find("/graphic/image"), std::string::npos) << names;
  EXPECT_NE(names.find("has the inks Blue, Black, the printer has blue, pink"), std::string::npos) << names;
  const auto count = issues(config(by_solids("g.tif", ink("blue"))));
  EXPECT_NE(count.find("has 2 inks (Blue, Black), the printer has 1 (blue)"), std::string::npos) << count;
}

TEST_F(GraphicLayers, NoChannelServesTwoInks) {
  write_inks("g.tif", {"Blue", "Black"});
  const auto text = issues(config(by_solids("g.tif", ink("blue") + "," + ink("BLUE"))));
  EXPECT_NE(text.find("each once"), std::string::npos) << text;
}

TEST_F(GraphicLayers, InksOfTheirOwnHaveNoShareOutOfGamut) {
  graphics::test::write_synthetic_profile(folder / "p.icc");
  write_inks("g.tif", {"1", "2", "3", "4", "5", "6"});
  const auto c = config(R"("image":"g.tif","pitch_mm":1,"print_dpi":50,"profile":"p.icc")");
  EXPECT_EQ(issues(c), "");
  const auto use = graphic_use(c, load_graphic(c, 2));
  EXPECT_EQ(use.layers_of_inks, 1);
  ASSERT_TRUE(use.profile);
  EXPECT_TRUE(std::isnan(use.profile->out_of_gamut_share)) << "nothing was mapped: a zero would be a result";
}

TEST_F(GraphicLayers, ASeparatedFileTooSmallForTheSlabIsRefused) {
  write_inks("g.tif", {"Blue"});
  const auto text = issues(config(by_solids("g.tif", ink("blue")) + R"(,"origin_x_mm":60)"));
  EXPECT_NE(text.find("is 120 mm x 220 mm"), std::string::npos) << text;
}

TEST_F(GraphicLayers, AFileThatIsNoProfileIsRefusedAtItsKey) {
  write_text_atomically(folder / "p.icc", "no profile");
  const auto text = issues(config(R"("image":")" VENATO_SOURCE_DIR R"(/configs/images/pov_calacatta_1600x3200.jpg","pitch_mm":1,"profile":"p.icc")"));
  EXPECT_NE(text.find("/graphic/profile"), std::string::npos) << text;
  EXPECT_NE(text.find("is not an ICC profile"), std::string::npos) << text;
}

TEST_F(GraphicLayers, ARunByProfileCarriesItIntoEveryFileThatTellsColours) {
  graphics::test::write_synthetic_profile(folder / "p.icc");
  const std::string graphic = R"("image":")" VENATO_SOURCE_DIR
                              R"(/configs/images/pov_calacatta_1600x3200.jpg","pitch_mm":1,"origin_x_mm":300,"origin_y_mm":700,"print_dpi":50,)"
                              R"("profile":"p.icc","profile_intent":"relative_colorimetric")";
  const auto c = config(graphic);
  const auto log = make_null_log();
  const auto progress = make_null_progress();
  Store store(folder / "store");
  Context context{*log, *progress, store, 0, 2, nullptr};
  run_line(c, folder / "run", context);

  const auto profile = read_file(folder / "p.icc"), print = read_file(folder / "run/masks/print.tif");
  EXPECT_NE(print.find(profile), std::string::npos) << "tag 34675";
  const auto info = graphics::read_tiff_info(folder / "run/masks/print.tif");
  EXPECT_EQ(info.ink_names, (std::vector<std::string>{"Blue_1", "Brown", "Beige", "Yellow", "Pink", "Black"}));
  EXPECT_TRUE(std::filesystem::exists(folder / "run/masks/print_Blue_1.tif"));
  const auto masks = Json::parse(read_file(folder / "run/masks/masks.json"));
  EXPECT_EQ(masks.at("profile").at("description"), "synthetic, not a printer");
  EXPECT_EQ(masks.at("profile").at("sha256"), sha256_of_file(folder / "p.icc"));
  EXPECT_EQ(masks.at("profile").at("intent"), "relative_colorimetric");
  EXPECT_FALSE(masks.contains("colour_note")) << "not a preview";
  const auto html = read_file(folder / "run/report.html");
  EXPECT_NE(html.find("synthetic, not a printer"), std::string::npos);
  EXPECT_NE(html.find("relative colorimetric"), std::string::npos);
  EXPECT_NE(html.find("Blue_1, Brown"), std::string::npos);

  // The preview is the mean ink of each box seen through the profile; here a box is one pixel.
  const auto preview = graphics::load_picture(folder / "run/masks/preview.png", 1e-3).pixels;
  const auto seen = graphics::see_by_profile(graphics::read_tiff8(folder / "run/masks/print.tif"), folder / "p.icc", 1).srgb;
  EXPECT_EQ(preview.data, seen.data);

  MaskChoices inverted;
  inverted.print_polarity = sync::Polarity::zero_is_full_ink;
  write_masks_of_run(folder / "run", folder / "inverted", {}, inverted, context, stages);
  EXPECT_EQ(read_file(folder / "inverted/print.tif").find(profile), std::string::npos)
      << "samples that count the other way round are not the profile's";

  graphics::test::SyntheticProfile other;
  other.nodes_to_inks = 17;
  graphics::test::write_synthetic_profile(folder / "p.icc", other);
  try {
    write_masks_of_run(folder / "run", folder / "again", {}, {}, context, stages);
    ADD_FAILURE() << "another profile than the run's was accepted";
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("p.icc: has changed since the run"), std::string::npos) << e.what();
  }
}
}  // namespace
}  // namespace venato::line
