/// The whole path config -> run folder on a small slab, with stages that need no simulation: what a run writes, and what it promises about it.
#include "line/chain/run_line.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/h5/h5_file.h"
#include "base/io/atomic_file.h"
#include "base/store/store.h"
#include "graphics/tiff/tiff_file.h"
#include "line/report/report.h"
#include "tests/base/temp_folder.h"
#include "tests/line/support/fake_line.h"
namespace venato::line {
namespace {
using Json = nlohmann::json;

/// 300 x 600 mm out of the calacatta picture, the belt stretched, the slab cut 2 mm and 0.2 deg off.
const std::vector<Override> kSlab{{"/slab/fired_width_mm", "300"},
                                  {"/slab/fired_length_mm", "600"},
                                  {"/grid", R"({"pitch_mm":1,"layers":2})"},
                                  {"/design/origin_x_mm", "500"},
                                  {"/design/origin_y_mm", "1000"},
                                  {"/graphic/origin_x_mm", "500"},
                                  {"/graphic/origin_y_mm", "1000"},
                                  {"/belt_jitter", R"({"amplitude_mm":1.5,"correlation_mm":400})"},
                                  {"/cut", R"({"offset_x_mm":2,"offset_y_mm":-2,"rotation_deg":0.2})"}};

struct Bench {
  Bench() : stages(fake::stages()), store(folder / "store"), log(make_null_log()), progress(make_null_progress()) {}
  RunOutcome run(const std::string& out, int threads, std::vector<Override> more = {}) {
    auto overrides = kSlab;
    overrides.insert(overrides.end(), more.begin(), more.end());
    const auto config = load_line_config_text(fake::config_text(), "/", overrides, stages);
    Context context{*log, *progress, store, 0, threads, nullptr};
    return run_line(config, folder / out, context);
  }
  Json json(const std::string& file) { return Json::parse(read_file(folder / file)); }
  TempFolder folder;
  std::vector<StageDescriptor> stages;
  Store store;
  std::unique_ptr<Log> log;
  std::unique_ptr<Progress> progress;
};

TEST(RunLine, FolderHoldsWhatTheContractSays) {
  Bench t;
  const auto outcome = t.run("out", 2);
  for (const char* file : {"run.json", "run.h5", "score.json", "report.html", "vein_map.tif", "masks/print.tif", "masks/print_black.tif",
                           "masks/powder_grey.tif", "masks/powder_white.tif", "masks/feed_vein_grey.csv", "masks/feed_vein_grey.tif",
                           "masks/masks.json", "masks/preview.png", "figures/overlay_after.png", "figures/visibility.png"})
    EXPECT_TRUE(std::filesystem::exists(t.folder / "out" / file)) << file;
  for (const auto& entry : std::filesystem::directory_iterator(t.folder / "out"))
    EXPECT_EQ(entry.path().filename().string().find("partial"), std::string::npos);

  const auto score = t.json("out/score.json");
  EXPECT_EQ(score.at("details").at("visibility").at("before").size(), 3u);  // 0.5, 1 and 2 m
  EXPECT_NE(read_file(t.folder / "out/report.html").find("Visibly off from 1 m"), std::string::npos);
  EXPECT_GT(score.at("details").at("visibility").at("vein_to_ground_delta_e2000").get<double>(), 1);
  ASSERT_TRUE(outcome.registered) << outcome.reason;
  EXPECT_TRUE(score.at("registration").at("success"));
  const auto median = [&](const char* which) { return score.at(which).at("centreline_error_mm").at("median").get<double>(); };
  // Cut 2.8 mm off and a belt stretched by 1.5 mm rms: the designed print is a millimetre or more off (along the vein normal, which sees part of it),
  // a registration at 1 mm pixels is not (its known error is 0.2 to 0.6 mm).
  EXPECT_GT(median("before"), 1.0);
  EXPECT_LT(median("after"), 0.6 * median("before"));
  EXPECT_LT(median("best_reachable"), 0.6 * median("before"));

  const auto run = t.json("out/run.json");
  EXPECT_EQ(run.at("format"), "venato-run");
  ASSERT_EQ(run.at("result").at("stages").size(), 2u);
  for (const auto& s : run.at("result").at("stages")) {
    EXPECT_NEAR(s.at("mass_in_kg").get<double>(), s.at("mass_out_kg").get<double>(), 1e-6 * s.at("mass_in_kg").get<double>());
    EXPECT_FALSE(s.at("cached"));
  }
  EXPECT_NEAR(run.at("result").at("mass").at("feed_commands_kg").get<double>(), run.at("result").at("mass").at("slab_strip_kg").get<double>(), 1e-5);
  EXPECT_LT(run.at("result").at("registration").at("against_simulation_mm").at("after").at("median").get<double>(), 1.0);
  EXPECT_EQ(run.at("input"), Json::parse(load_line_config_text(fake::config_text(), "/", kSlab, t.stages).resolved_json));

  H5Reader h5(t.folder / "out/run.h5", "venato-run", 1);
  for (const auto& name : h5.dataset_names()) {
    const auto meta = h5.meta(name);
    EXPECT_FALSE(meta.units.empty() || meta.axes.empty() || meta.frame.empty() || meta.description.empty()) << name;
  }

  const auto html = read_file(t.folder / "out/report.html");
  for (const char* outside : {"http://", "https://", "src=\"figures"})
    EXPECT_EQ(html.find(outside), std::string::npos) << "the page must hold everything itself: " << outside;
  write_report(t.folder / "out");
  EXPECT_EQ(read_file(t.folder / "out/report.html"), html) << "venato report rebuilds the same page";
}

TEST(RunLine, DataAreTheSameBytesForAnyThreadCountAndFromTheStore) {
  Bench t;
  t.run("one", 1);
  t.run("four", 4);
  EXPECT_EQ(sha256_hex(read_file(t.folder / "one/run.h5")), sha256_hex(read_file(t.folder / "four/run.h5")));
  EXPECT_EQ(read_file(t.folder / "one/score.json"), read_file(t.folder / "four/score.json"));
  EXPECT_EQ(sha256_hex(read_file(t.folder / "one/masks/print.tif")), sha256_hex(read_file(t.folder / "four/masks/print.tif")));
  EXPECT_TRUE(t.json("four/run.json").at("result").at("stages")[0].at("cached"));
}

TEST(RunLine, AKnownShiftOfTheGraphicIsFound) {
  Bench t;
  t.run("as_is", 2);
  const auto outcome = t.run("shifted", 2, {{"/graphic/placement", R"({"dx_mm":10,"dy_mm":-6,"rotation_deg":1})"}});
  ASSERT_TRUE(outcome.registered) << outcome.reason;
  const auto plain = t.json("as_is/score.json"), shifted = t.json("shifted/score.json");
  const auto median = [](const Json& j, const char* which) { return j.at(which).at("centreline_error_mm").at("median").get<double>(); };
  EXPECT_NEAR(median(shifted, "after"), median(plain, "after"), 0.3);
  // The move is 11.7 mm; veins that leave the search reach of 15 mm do not count, so matched length falls as well.
  EXPECT_GT(median(shifted, "before"), 3.0);
}

TEST(RunLine, AnUnrelatedGraphicIsRefusedHonestly) {
  Bench t;
  const auto outcome =
      t.run("out", 2, {{"/graphic/image", std::string("\"") + VENATO_SOURCE_DIR + "/configs/images/pov_arabescato_1600x3200.jpg\""}});
  EXPECT_FALSE(outcome.registered);
  EXPECT_FALSE(outcome.reason.empty());
  const auto score = t.json("out/score.json");
  EXPECT_FALSE(score.at("registration").at("success"));
  EXPECT_TRUE(score.at("after").at("centreline_error_mm").at("median").is_null());
  EXPECT_NE(read_file(t.folder / "out/report.html").find("Not synchronised"), std::string::npos);
}

TEST(RunLine, PictureTooSmallIsRefusedBeforeAnythingIsMade) {
  Bench t;
  EXPECT_THROW(t.run("out", 1, {{"/design/origin_x_mm", "1500"}}), ConfigError);
  EXPECT_FALSE(std::filesystem::exists(t.folder / "out"));
}
}  // namespace
}  // namespace venato::line
