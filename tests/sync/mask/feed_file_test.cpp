#include "sync/mask/feed_file.h"

#include <gtest/gtest.h>

#include <sstream>

#include "base/error.h"
#include "base/units.h"
#include "graphics/tiff/tiff_file.h"
#include "tests/sync/mask/mask_fixture.h"

namespace venato::sync {
namespace {

TEST(FeedFile, TableHasUnitsAndOneRowPerTick) {
  const FeedFile feed{"head_a", "grey", 3, 4, 0.005, 0.0125, 0.1, 3.5, {0, 1, 0.5, 0, 0, 0, 1, 1, 1, 0.25, 0.125, 0.0625}};
  std::istringstream text(feed_csv_text(feed));
  std::vector<std::string> comments, rows;
  for (std::string line; std::getline(text, line);) (line[0] == '#' ? comments : rows).push_back(line);
  const auto has = [&](const std::string& part) {
    for (const auto& line : comments)
      if (line.find(part) != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(has("powder: grey"));
  EXPECT_TRUE(has("prong_pitch: 5 mm"));
  EXPECT_TRUE(has("tick: 12.5 ms"));
  EXPECT_TRUE(has("belt_speed: 0.1 m/s"));
  EXPECT_TRUE(has("full_rate: 3.5 kg/m2"));
  EXPECT_EQ(rows, (std::vector<std::string>{"time_ms,prong_0,prong_1,prong_2", "0,0,1,0.5", "12.5,0,0,0", "25,1,1,1", "37.5,0.25,0.125,0.0625"}));
}

TEST(FeedFile, PictureIsOnePixelPerProngAndTick) {
  test::TempFolder out;
  const FeedFile feed{"head_a", "grey", 3, 2, 0.005, 0.0125, 0.1, 3.5, {0, 1, 0.5, 1, 0, 0.2}};
  write_feed(feed, out.path);
  const auto picture = graphics::read_tiff8(out.path / "feed_head_a.tif");
  EXPECT_EQ(picture.width, 3);
  EXPECT_EQ(picture.height, 2);
  EXPECT_EQ(picture.data, (std::vector<std::uint8_t>{0, 255, 128, 255, 0, 51}));
  EXPECT_NEAR(graphics::read_tiff_info(out.path / "feed_head_a.tif").dpi, kMetresPerInch / 0.005, 1e-4);  // TIFF stores a float
  EXPECT_EQ(test::bytes_of(out.path / "feed_head_a.csv"), feed_csv_text(feed));
}

TEST(FeedFile, RefusesWhatAHeadCannotDo) {
  const FeedFile good{"h", "grey", 1, 2, 0.005, 0.01, 0.1, 1, {0, 1}};
  EXPECT_NO_THROW(check_feed(good));
  FeedFile bad = good;
  bad.duty[0] = std::nan("");
  EXPECT_THROW(check_feed(bad), UsageError);
  bad = good;
  bad.tick_s = 0;
  EXPECT_THROW(check_feed(bad), UsageError);
  bad = good;
  bad.name = "a/b";
  EXPECT_THROW(check_feed(bad), UsageError);
}

}  // namespace
}  // namespace venato::sync
