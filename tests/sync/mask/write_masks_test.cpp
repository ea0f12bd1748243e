#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/units.h"
#include "graphics/tiff/tiff_file.h"
#include "sync/mask/mask_job.h"
#include "tests/sync/mask/mask_fixture.h"

namespace venato::sync {
namespace {

using nlohmann::json;
using test::small_job;
using test::TempFolder;
using test::TestContext;
namespace fs = std::filesystem;

TEST(WriteMasks, WritesExactlyTheContractedFiles) {
  TestContext t;
  TempFolder out;
  const MaskJob job = small_job();
  const MaskSet set = write_masks(job, out.path / "masks", t.context);
  std::vector<std::string> names;
  for (const auto& [name, text] : test::contents(out.path / "masks")) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"feed_vein_grey.csv", "feed_vein_grey.tif", "masks.json", "powder_grey.tif", "preview.png", "print.tif",
                                             "print_beige.tif", "print_black.tif", "print_blue.tif", "print_brown.tif", "print_pink.tif",
                                             "print_yellow.tif"}));
  EXPECT_EQ(set.width_px, std::llround(0.0423 / kMetresPerInch * 360));
  EXPECT_EQ(set.height_px, std::llround(0.0317 / kMetresPerInch * 360));
  EXPECT_FALSE(set.big_tiff);
}

TEST(WriteMasks, PrintHoldsTheWarpedInksAndTheirTags) {
  TestContext t;
  TempFolder out;
  const MaskJob job = small_job();
  const MaskSet set = write_masks(job, out.path, t.context);
  const graphics::TiffInfo info = graphics::read_tiff_info(out.path / "print.tif");
  EXPECT_EQ(info.kind, graphics::TiffKind::separated);
  EXPECT_EQ(info.channels, 6);
  EXPECT_EQ(info.ink_names, (std::vector<std::string>{"blue", "brown", "beige", "yellow", "pink", "black"}));
  EXPECT_NEAR(info.dpi, 360, 1e-3);  // TIFF rationals hold 360 exactly; float in between
  EXPECT_EQ(info.no_ink_value, 0);
  EXPECT_NO_THROW(EXPECT_EQ(json::parse(info.description).at("slab_id"), "slab-42"));

  const graphics::Raster8 print = graphics::read_tiff8(out.path / "print.tif");
  const WarpGrid grid{set.width_px, set.height_px, set.pitch_m};
  const auto want = test::warp_all(job.layers[0].ink, job.print_from_green, grid, 64, 1);
  EXPECT_EQ(print.data, want);
  for (std::size_t c = 0; c < job.inks.size(); ++c) {
    const fs::path file = out.path / ("print_" + job.inks[c].name + ".tif");
    const graphics::Raster8 ink = graphics::read_tiff8(file);
    EXPECT_EQ(graphics::read_tiff_info(file).kind, graphics::TiffKind::grey);
    EXPECT_NEAR(graphics::read_tiff_info(file).dpi, 360, 1e-3);
    ASSERT_EQ(ink.data.size() * 6, want.size());
    for (std::size_t k = 0; k < ink.data.size(); ++k) ASSERT_EQ(ink.data[k], 255 - want[k * 6 + c]) << "0 = full ink";
  }
}

TEST(WriteMasks, PolarityIsAnOptionOfBothKinds) {
  TestContext t;
  TempFolder out;
  MaskJob job = small_job(4);
  write_masks(job, out.path / "a", t.context);
  job.print_polarity = Polarity::zero_is_full_ink;
  job.ink_file_polarity = Polarity::zero_is_no_ink;
  write_masks(job, out.path / "b", t.context);
  const auto a = graphics::read_tiff8(out.path / "a/print.tif"), b = graphics::read_tiff8(out.path / "b/print.tif");
  for (std::size_t k = 0; k < a.data.size(); ++k) ASSERT_EQ(a.data[k], 255 - b.data[k]);
  EXPECT_EQ(graphics::read_tiff_info(out.path / "b/print.tif").no_ink_value, 255);
  const auto ia = graphics::read_tiff8(out.path / "a/print_blue.tif"), ib = graphics::read_tiff8(out.path / "b/print_blue.tif");
  for (std::size_t k = 0; k < ia.data.size(); ++k) ASSERT_EQ(ia.data[k], 255 - ib.data[k]);
  const json sidecar = json::parse(test::bytes_of(out.path / "b/masks.json"));
  EXPECT_EQ(sidecar.at("polarity").at("print.tif"), "0 = full ink, 255 = no ink");
  // The preview shows the same picture whatever the files' polarity.
  EXPECT_EQ(test::bytes_of(out.path / "a/preview.png"), test::bytes_of(out.path / "b/preview.png"));
}

TEST(WriteMasks, SameBytesForAnyThreadCount) {
  TestContext t;
  TempFolder out;
  const MaskJob job = small_job();
  t.context.threads = 1;
  write_masks(job, out.path / "1", t.context);
  for (const int threads : {2, 4}) {
    t.context.threads = threads;
    write_masks(job, out.path / "n", t.context);
    EXPECT_TRUE(test::contents(out.path / "1") == test::contents(out.path / "n")) << threads;
  }
}

TEST(WriteMasks, SidecarDescribesTheFilesAndTheTransform) {
  TestContext t;
  TempFolder out;
  const MaskJob job = small_job();
  write_masks(job, out.path, t.context);
  const json j = json::parse(test::bytes_of(out.path / "masks.json"));
  EXPECT_EQ(j.at("format"), "venato-masks");
  EXPECT_EQ(j.at("slab_id"), "slab-42");
  EXPECT_NEAR(j.at("mm_per_px").get<double>(), 25.4 / 360, 1e-12);
  ASSERT_EQ(j.at("inks").size(), 6u);
  EXPECT_EQ(j.at("inks")[1].at("name"), "brown");
  EXPECT_EQ(j.at("files").size(), 11u);
  for (const auto& file : j.at("files")) {
    const std::string bytes = test::bytes_of(out.path / file.at("name").get<std::string>());
    EXPECT_EQ(file.at("bytes").get<std::size_t>(), bytes.size());
    EXPECT_EQ(file.at("sha256"), sha256_hex(bytes)) << file.at("name");
  }
  // The transform rebuilt from the sidecar is the transform used.
  const auto& p = j.at("print_from_green");
  Transform map;
  map.a << p.at("a")[0][0], p.at("a")[0][1], p.at("a")[1][0], p.at("a")[1][1];
  map.t = Point(p.at("t_mm")[0].get<double>() / 1e3, p.at("t_mm")[1].get<double>() / 1e3);
  map.u.origin_m = Point(p.at("u").at("origin_mm")[0].get<double>() / 1e3, p.at("u").at("origin_mm")[1].get<double>() / 1e3);
  map.u.spacing_m = p.at("u").at("spacing_mm").get<double>() / 1e3;
  map.u.nx = p.at("u").at("nx");
  map.u.ny = p.at("u").at("ny");
  for (const double v : p.at("u").at("coefficients_x_mm")) map.u.cx.push_back(v / 1e3);
  for (const double v : p.at("u").at("coefficients_y_mm")) map.u.cy.push_back(v / 1e3);
  for (const Point& at : {Point(0.001, 0.002), Point(0.02, 0.03), Point(0.041, 0.011)})
    EXPECT_LT((map(at) - job.print_from_green(at)).norm(), 1e-12);  // decimal text of doubles, rounding only
}

TEST(WriteMasks, OnlyVeinLayersAreWarpedAndLayersAddUp) {
  TestContext t;
  TempFolder out;
  MaskJob job = small_job(3);
  InkLayer background{"background", test::bands(90, 70, 3, 0.0005), false};
  for (auto& v : background.ink.data) v = static_cast<std::uint8_t>(v / 2);
  job.layers.push_back(background);
  const MaskSet set = write_masks(job, out.path, t.context);
  const WarpGrid grid{set.width_px, set.height_px, set.pitch_m};
  const auto veins = test::warp_all(job.layers[0].ink, job.print_from_green, grid, 64, 1);
  const auto ground = test::warp_all(background.ink, job.pose_from_green, grid, 64, 1);
  const auto print = graphics::read_tiff8(out.path / "print.tif");
  int saturated = 0;
  for (std::size_t k = 0; k < veins.size(); ++k) {
    ASSERT_EQ(print.data[k], std::min(255, veins[k] + ground[k]));
    saturated += veins[k] + ground[k] > 255;
  }
  EXPECT_GT(saturated, 100);
}

TEST(WriteMasks, OnePixelSlab) {
  TestContext t;
  TempFolder out;
  MaskJob job = small_job(1);
  job.width_m = job.height_m = kMetresPerInch / 360;
  const MaskSet set = write_masks(job, out.path, t.context);
  EXPECT_EQ(set.width_px * set.height_px, 1);
  EXPECT_EQ(graphics::read_tiff8(out.path / "print.tif").data.size(), 1u);
}

TEST(WriteMasks, RefusesJobsThatMakeNoSense) {
  TestContext t;
  TempFolder out;
  const auto expect_refused = [&](auto change, const std::string& word) {
    MaskJob job = small_job();
    change(job);
    try {
      write_masks(job, out.path / "masks", t.context);
      ADD_FAILURE() << "accepted: " << word;
    } catch (const UsageError& e) {
      EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
    EXPECT_FALSE(fs::exists(out.path / "masks"));
  };
  expect_refused([](MaskJob& j) { j.dpi = 5; }, "dpi");
  expect_refused([](MaskJob& j) { j.dpi = std::nan(""); }, "dpi");
  expect_refused([](MaskJob& j) { j.width_m = -1; }, "width");
  expect_refused([](MaskJob& j) { j.inks.clear(); }, "inks");
  expect_refused([](MaskJob& j) { j.inks[0].name = "../evil"; }, "file name");
  expect_refused([](MaskJob& j) { j.inks[0].name = j.inks[1].name; }, "twice");
  expect_refused([](MaskJob& j) { j.inks.pop_back(); }, "channels");
  expect_refused([](MaskJob& j) { j.layers.clear(); }, "layer");
  expect_refused([](MaskJob& j) { j.feeds[0].duty[1] = 1.5; }, "outside [0, 1]");
  expect_refused([](MaskJob& j) { j.feeds[0].duty.pop_back(); }, "duties");
  expect_refused([](MaskJob& j) { j.powders[0].fraction = {}; }, "either");
  expect_refused([](MaskJob& j) { j.print_from_green.t.x() = std::nan(""); }, "transform");
  expect_refused(
      [](MaskJob& j) {
        Rng rng(1, stream_id("test/mask/screen"));
        for (auto& v : j.layers[0].ink.data) v = rng.below(3) ? 0 : 255;
      },
      "screened");
}

TEST(WriteMasks, FailureLeavesTheOldFilesAndNothingElse) {
  TestContext t;
  TempFolder out;
  MaskJob job = small_job(2);
  write_masks(job, out.path, t.context);
  const auto before = test::contents(out.path);
  job.dpi = 300;
  t.stop = true;
  EXPECT_THROW(write_masks(job, out.path, t.context), Interrupted);
  EXPECT_TRUE(test::contents(out.path) == before);
  t.stop = false;
  // A folder where print.tif should go: the last step, moving the files into place, cannot succeed.
  TempFolder blocked;
  fs::create_directory(blocked.path / "print.tif");
  EXPECT_THROW(write_masks(job, blocked.path, t.context), WorkError);
  EXPECT_EQ(test::contents(blocked.path).size(), 1u);
  EXPECT_THROW(write_masks(job, "/proc/masks", t.context), UsageError);
}

TEST(WriteMasks, ChecksTheDiskBeforeItStarts) {
  TestContext t;
  if (!fs::exists("/dev/shm")) GTEST_SKIP() << "no small file system here";
  MaskJob job = small_job(8);
  job.compression = graphics::TiffCompression::none;
  const double free_bytes = static_cast<double>(fs::space("/dev/shm").available);
  job.dpi = 1200;
  job.width_m = 6;  // 283 000 px
  job.height_m = std::min(6.0, free_bytes * 1.5 / 8 / 283464.0 * kMetresPerInch / 1200);
  if (283464.0 * 8 * job.height_m / kMetresPerInch * 1200 * 2 < free_bytes) GTEST_SKIP() << "/dev/shm is too large to overfill";
  const fs::path folder = "/dev/shm/venato_mask_test_" + std::to_string(::getpid());
  try {
    write_masks(job, folder, t.context);
    ADD_FAILURE() << "wrote more than fits";
  } catch (const WorkError& e) {
    EXPECT_NE(std::string(e.what()).find("GiB free"), std::string::npos) << e.what();
  }
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace venato::sync
