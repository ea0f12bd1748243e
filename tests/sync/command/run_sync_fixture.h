#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "graphics/graphic.h"
#include "graphics/raster/mask.h"
#include "graphics/raster/resample.h"
#include "graphics/tiff/tiff_file.h"
#include "sync/command/sync_command.h"
#include "tests/sync/command/vein_pictures.h"
#include "tests/sync/mask/mask_fixture.h"

namespace venato::sync::test {
using nlohmann::json;
namespace fs = std::filesystem;

inline constexpr double kWidth_m = 0.40, kHeight_m = 0.60;  // the slab; the graphic is 40 mm larger both ways

struct Case {
  TempFolder folder;
  TestContext context;
  Transform truth = known_map(kWidth_m, kHeight_m);
  SyncOptions options;

  /// Fraction map as `venato run` writes it: float TIFF, two channels, body first. What was planned from the graphic, moved and blurred by the line.
  void write_planned_fractions(std::uint64_t seed) {
    const auto design = painted(vein_raster(VeinField(seed), Transform{}, 440, 640, 0.001), 2);
    const auto plan = graphics::gaussian(graphics::channel(graphics::plan_veins(design, {}, {"body", "vein"}, 0, 1).fraction, 1), 4.0);
    graphics::RasterF vein(400, 600, 1, 0.001);
    for (int j = 0; j < 600; ++j)
      for (int i = 0; i < 400; ++i) {
        const Point p = truth(Point((i + 0.5) * 0.001, (j + 0.5) * 0.001)) / 0.001 - Point(0.5, 0.5);
        const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
        const float fx = static_cast<float>(p.x() - x), fy = static_cast<float>(p.y() - y);
        vein.at(i, j) =
            (1 - fy) * ((1 - fx) * plan.at(x, y) + fx * plan.at(x + 1, y)) + fy * ((1 - fx) * plan.at(x, y + 1) + fx * plan.at(x + 1, y + 1));
      }
    write_map(vein);
  }
  /// Veins as the graphic has them, without the plan's widening.
  void write_fractions(std::uint64_t seed) { write_map(vein_raster(VeinField(seed), truth, 400, 600, 0.001)); }
  void write_map(const graphics::RasterF& vein) {
    graphics::RasterF map(400, 600, 2, 0.001);
    for (std::size_t k = 0; k < vein.data.size(); ++k) {
      map.data[2 * k] = 1 - vein.data[k];
      map.data[2 * k + 1] = vein.data[k];
    }
    options.vein_map = folder.path / "vein_map.tif";
    graphics::write_tiff(options.vein_map, map, {}, 1);
  }
  void write_camera(std::uint64_t seed) {
    options.vein_map = folder.path / "camera.png";
    graphics::write_png(options.vein_map, painted(vein_raster(VeinField(seed), truth, 800, 1200, 0.0005), 1));
    options.vein_pitch_m = 0.0005;
  }
  void write_graphic(std::uint64_t seed) {
    options.graphic = folder.path / "graphic.png";
    graphics::write_png(options.graphic, painted(vein_raster(VeinField(seed), Transform{}, 880, 1280, 0.0005), 2));
    options.graphic_pitch_m = 0.0005;
  }
  int run() {
    options.out = folder.path / "out";
    return run_sync(options, context.context);
  }
  json score() { return json::parse(bytes_of(options.out / "score.json")); }
};

/// The call must be refused with `word` in the message and no result.
inline void expect_usage_error(Case& c, const std::string& word) {
  try {
    c.run();
    ADD_FAILURE() << "accepted; expected " << word;
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
  EXPECT_FALSE(fs::exists(c.options.out / "score.json"));
}
inline void expect_same_bytes_for_any_threads(Case& c) {
  c.context.context.threads = 1;
  EXPECT_EQ(c.run(), 0);
  const auto one = contents(c.options.out);
  c.context.context.threads = 2;
  c.run();
  EXPECT_TRUE(one == contents(c.options.out));
}

struct MapRow {
  double xg, yg, xp, yp, sigma;
};
inline std::vector<MapRow> read_map(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "x_green_mm,y_green_mm,x_graphic_mm,y_graphic_mm,sigma_mm");
  std::vector<MapRow> rows;
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text(line);
    MapRow r{};
    text >> r.xg >> r.yg >> r.xp >> r.yp >> r.sigma;
    rows.push_back(r);
  }
  return rows;
}

/// Distance [mm] of map.csv to the truth: median of all grid points.
inline double median_map_error_mm(const std::vector<MapRow>& rows, const Transform& truth) {
  std::vector<double> errors;
  for (const MapRow& r : rows) {
    const Point p = truth(Point(r.xg, r.yg) / 1e3) * 1e3;
    errors.push_back(std::hypot(r.xp - p.x(), r.yp - p.y()));
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return errors[errors.size() / 2];
}

inline void expect_contract(const json& score) {
  for (const char* which : {"before", "after", "best_reachable"}) {
    const json& m = score.at(which);
    EXPECT_TRUE(m.at("centreline_error_mm").contains("median"));
    EXPECT_TRUE(m.at("centreline_error_mm").contains("p95"));
    for (const char* tolerance : {"1mm", "2mm", "3mm"}) EXPECT_TRUE(m.at("boundary_f1").contains(tolerance));
    EXPECT_TRUE(m.contains("matched_length"));
    EXPECT_TRUE(m.contains("dice"));
  }
  EXPECT_TRUE(score.at("registration").at("success").is_boolean());
  EXPECT_TRUE(score.at("registration").at("reason").is_string());
  EXPECT_GE(score.at("registration").at("confidence").get<double>(), 0);
  EXPECT_LE(score.at("registration").at("confidence").get<double>(), 1);
}

inline void expect_registered(Case& c) {
  EXPECT_EQ(c.run(), 0);
  const json score = c.score();
  expect_contract(score);
  EXPECT_TRUE(score.at("registration").at("success").get<bool>()) << score.at("registration").at("reason");
  EXPECT_EQ(score.at("registration").at("reason"), "");
  // The known map moves veins by 10 to 25 mm; registration on such veins is good to some tenths (registration_print.md 1.4). Twice 0.3 mm.
  EXPECT_LT(score.at("after").at("centreline_error_mm").at("median").get<double>(), 0.6);
  EXPECT_GT(score.at("after").at("matched_length").get<double>(), 0.9);
  EXPECT_GT(score.at("after").at("dice").get<double>(), score.at("before").at("dice").get<double>() + 0.3);
  EXPECT_LT(score.at("best_reachable").at("centreline_error_mm").at("median").get<double>(), 0.6);
  EXPECT_GT(score.at("best_reachable").at("dice").get<double>(), 0.9);
  EXPECT_FALSE(score.at("best_reachable_definition").get<std::string>().empty());
  const auto rows = read_map(c.options.out / "map.csv");
  EXPECT_EQ(rows.size(), 41u * 61u);  // 0 to 400 and 0 to 600 mm
  EXPECT_EQ(rows[1].xg, 10);
  EXPECT_EQ(rows[41].yg, 10);
  EXPECT_LT(median_map_error_mm(rows, c.truth), 1.0);
  for (const MapRow& r : rows) ASSERT_GT(r.sigma, 0);
  EXPECT_TRUE(fs::exists(c.options.out / "overlay.png"));
}
}  // namespace venato::sync::test
