/// `venato masks` on a finished run of stages that need no simulation.
#include "line/chain/masks_of_run.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "graphics/tiff/tiff_file.h"
#include "tests/base/temp_folder.h"
#include "tests/line/support/fake_line.h"
namespace venato::line {
namespace {
namespace fs = std::filesystem;

/// One run for all tests: a 100 x 200 mm slab, its graphic a copy that the tests may change.
class MasksOfRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new Shared;
    fs::copy_file(VENATO_SOURCE_DIR "/configs/images/pov_calacatta_1600x3200.jpg", graphic());
    const std::vector<Override> overrides{{"/graphic/image", "\"graphic.jpg\""}, {"/belt_jitter", R"({"amplitude_mm":1,"correlation_mm":300})"}};
    const auto config = load_line_config_text(fake::config_text(), shared_->folder.path(), overrides, shared_->stages);
    run_line(config, run(), shared_->context);
  }
  static void TearDownTestSuite() { delete shared_; }
  static fs::path run() { return shared_->folder / "run"; }
  static fs::path graphic() { return shared_->folder / "graphic.jpg"; }
  static fs::path again(const fs::path& from, const std::string& name, std::optional<double> dpi = {}, const MaskChoices& choices = {}) {
    const auto out = shared_->folder / name;
    write_masks_of_run(from, out, dpi, choices, shared_->context, shared_->stages);
    return out;
  }
  static std::string refusal(const fs::path& from) {
    try {
      again(from, "refused");
    } catch (const UsageError& e) {
      EXPECT_FALSE(fs::exists(shared_->folder / "refused"));
      return e.what();
    }
    ADD_FAILURE() << "accepted " << from;
    return "";
  }

 private:
  struct Shared {
    TempFolder folder;
    std::vector<StageDescriptor> stages = fake::stages();
    Store store{folder / "store"};
    std::unique_ptr<Log> log = make_null_log();
    std::unique_ptr<Progress> progress = make_null_progress();
    Context context{*log, *progress, store, 0, 2, nullptr};
  };
  static inline Shared* shared_ = nullptr;
};

TEST_F(MasksOfRun, WritesTheSameBytesAsTheRun) {
  const auto out = again(run(), "same");
  int files = 0;
  for (const auto& entry : fs::directory_iterator(run() / "masks")) {
    ++files;
    EXPECT_TRUE(read_file(entry.path()) == read_file(out / entry.path().filename())) << entry.path();
  }
  EXPECT_GE(files, 9);
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), files);
}

TEST_F(MasksOfRun, AnotherResolutionCompressionAndPolarity) {
  MaskChoices choices;
  choices.compression = graphics::TiffCompression::lzw;
  choices.print_polarity = sync::Polarity::zero_is_full_ink;
  choices.powders_at_print_resolution = true;
  const auto out = again(run(), "other", 100, choices);
  const auto was = graphics::read_tiff_info(run() / "masks/print.tif"), is = graphics::read_tiff_info(out / "print.tif");
  EXPECT_NEAR(was.dpi, 50, 1e-3);
  EXPECT_NEAR(is.dpi, 100, 1e-3);
  EXPECT_NEAR(static_cast<double>(is.width), 2.0 * static_cast<double>(was.width), 1);
  EXPECT_EQ(is.compression, graphics::TiffCompression::lzw);
  EXPECT_EQ(is.no_ink_value, 255);
  EXPECT_EQ(graphics::read_tiff_info(out / "powder_grey.tif").width, is.width);
}

TEST_F(MasksOfRun, WhatIsNoFinishedRunIsRefused) {
  EXPECT_NE(refusal("/nonexistent").find("finished run"), std::string::npos);
  TempFolder t;
  write_text_atomically(t / "run.json", "{}");
  EXPECT_NE(refusal(t.path()).find("not a run.json"), std::string::npos);
  fs::copy_file(run() / "run.json", t / "run.json", fs::copy_options::overwrite_existing);
  EXPECT_NE(refusal(t.path()).find("run.h5"), std::string::npos);
  write_text_atomically(t / "run.h5", "no HDF5 at all");
  EXPECT_NE(refusal(t.path()).find("run.h5"), std::string::npos);
}

TEST_F(MasksOfRun, AGraphicThatHasChangedIsRefused) {
  std::ofstream(graphic(), std::ios::app) << "x";
  EXPECT_NE(refusal(run()).find("has changed since the run"), std::string::npos);
  fs::copy_file(VENATO_SOURCE_DIR "/configs/images/pov_calacatta_1600x3200.jpg", graphic(), fs::copy_options::overwrite_existing);
}
}  // namespace
}  // namespace venato::line
