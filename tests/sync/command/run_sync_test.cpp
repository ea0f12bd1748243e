#include "tests/sync/command/run_sync_fixture.h"

namespace venato::sync {
namespace {

using namespace test;

TEST(RunSync, FractionMapOfARunAndItsGraphic) {
  Case c;
  c.write_planned_fractions(5);
  c.write_graphic(5);
  expect_registered(c);
  const json details = c.score().at("details");
  EXPECT_EQ(details.at("evidence"), "vein fraction against planned veins");
  const json &before = details.at("visibility").at("before"), &after = details.at("visibility").at("after");
  ASSERT_EQ(after.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {  // unsynchronised, the eye sees all of it; a fit of some tenths of a millimetre leaves little
    EXPECT_GT(before[k].at("visible_length_percent").get<double>(), 80);
    EXPECT_LT(after[k].at("delta_e2000_mean").get<double>(), before[k].at("delta_e2000_mean").get<double>() / 3);
    EXPECT_LT(after[k].at("visible_length_percent").get<double>(), before[k].at("visible_length_percent").get<double>());
  }
  EXPECT_TRUE(fs::exists(c.options.out / "visibility.png"));
}

TEST(RunSync, PicturesThatDoNotBelongTogetherFailHonestly) {
  Case c;
  c.write_fractions(5);
  c.write_graphic(6);
  fs::create_directories(c.folder.path / "out");
  std::ofstream(c.folder.path / "out/map.csv") << "of an earlier run\n";
  EXPECT_EQ(c.run(), 1);
  const json score = c.score();
  expect_contract(score);
  EXPECT_FALSE(score.at("registration").at("success").get<bool>());
  EXPECT_FALSE(score.at("registration").at("reason").get<std::string>().empty());
  EXPECT_TRUE(score.at("after").at("dice").is_null()) << "no transform may be scored as if it were one";
  EXPECT_TRUE(score.at("best_reachable").at("centreline_error_mm").at("median").is_null());
  EXPECT_FALSE(fs::exists(c.options.out / "map.csv"));
  EXPECT_TRUE(fs::exists(c.options.out / "overlay.png"));
}

TEST(RunSync, BlankPictureSaysSo) {
  Case c;
  c.write_fractions(5);
  c.options.graphic = c.folder.path / "blank.png";
  graphics::write_png(c.options.graphic, graphics::Raster8(440, 640, 3, 0.001, 230));
  c.options.graphic_pitch_m = 0.001;
  EXPECT_EQ(c.run(), 1);
  EXPECT_NE(c.score().at("registration").at("reason").get<std::string>().find("no veins"), std::string::npos);
}

TEST(RunSync, BadInputsAreUsageErrorsThatHelp) {
  Case c;
  c.write_fractions(5);
  c.write_graphic(5);
  const SyncOptions good = c.options;
  const auto expect_usage = [&](const std::string& word) {
    expect_usage_error(c, word);
    c.options = good;
  };
  c.options.vein_map = c.folder.path / "missing.tif";
  expect_usage("missing.tif");
  c.options.graphic = c.folder.path / "empty.png";
  std::ofstream(c.options.graphic).flush();
  expect_usage("empty.png");
  c.options.vein_pitch_m = -1;
  expect_usage("--vein-pitch-mm");
  c.options.graphic_pitch_m = std::nan("");
  expect_usage("--graphic-pitch-mm");
  // Float TIFF without dpi.
  graphics::RasterF map(50, 50, 2, 0, 0.5f);
  c.options.vein_map = c.folder.path / "nodpi.tif";
  graphics::write_tiff(c.options.vein_map, map, {}, 1);
  expect_usage("--vein-pitch-mm");
  // Lengths instead of fractions.
  graphics::RasterF heights(50, 50, 1, 0.001, 12.5f);
  c.options.vein_map = c.folder.path / "heights.tif";
  graphics::write_tiff(c.options.vein_map, heights, {}, 1);
  expect_usage("fractions");
  const std::string bytes = bytes_of(good.vein_map);
  c.options.vein_map = c.folder.path / "cut.tif";
  std::ofstream(c.options.vein_map, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  expect_usage("cut.tif");
  c.options = good;
  c.options.out = "/proc/none";
  EXPECT_THROW(run_sync(c.options, c.context.context), UsageError);
}

}  // namespace
}  // namespace venato::sync
