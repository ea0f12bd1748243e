#include "line/config/line_config.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/line/support/fake_line.h"
namespace venato::line {
namespace {

LineConfig load(const std::string& text, const std::vector<Override>& overrides = {}) {
  static const auto stages = fake::stages();
  return load_line_config_text(text, "/", overrides, stages);
}
/// All issues, one per line, of a config that must be refused.
std::string refused(const std::string& text, const std::vector<Override>& overrides = {}) {
  try {
    load(text, overrides);
  } catch (const ConfigError& e) {
    return e.what();
  }
  ADD_FAILURE() << "was accepted";
  return {};
}

TEST(LineConfig, ReadsToSi) {
  const auto c = load(fake::config_text());
  EXPECT_EQ(c.basics.fired_width_m, 0.1);
  EXPECT_EQ(c.basics.seed, 7u);
  EXPECT_EQ(c.basics.powders[1].name, "grey");
  EXPECT_EQ(c.basics.vein_powder, 1);
  EXPECT_DOUBLE_EQ(c.basics.firing_shrinkage, 0.07);
  EXPECT_DOUBLE_EQ(c.basics.materials.pair(LineBasics::kGrain, LineBasics::kBelt).restitution, 0.44);
  EXPECT_EQ(c.chain.size(), 2u);
  EXPECT_EQ(c.chain[1].pointer, "/chain/1");
  EXPECT_FALSE(c.placeholders.empty());
}

TEST(LineConfig, BedMassIsTheDomainTable) {
  // Domain notes 1.2: 12 mm fired at 2320 kg/m3, LOI 4.5 %, firing 7 % need 25.2 kg/m2 of dry powder per green area. The table is rounded to 0.1.
  const auto c = load(fake::config_text());
  const auto& b = c.basics;
  const double per_green_dry = b.bed_mass_kg_m2 / 1.055 / (1.005 * 1.005) / (0.999 * 0.999) * (0.999 * 0.999);
  EXPECT_NEAR(per_green_dry, 25.2, 0.05);
}

TEST(LineConfig, ScalesCompose) {
  const auto& b = load(fake::config_text()).basics;
  EXPECT_NEAR(b.belt_from_design() * 1.005 * 0.999 * 0.93, 1.0, 1e-12);
}

TEST(LineConfig, CoarseGridCoversTheSameStrip) {
  const auto c = load(fake::config_text());
  const auto coarse = coarse_basics(c, 0.005);
  EXPECT_NEAR(coarse.grid.nx * coarse.grid.pitch_m, c.basics.grid.nx * c.basics.grid.pitch_m, 1e-12);
  EXPECT_NEAR(coarse.grid.ny * coarse.grid.pitch_m, c.basics.grid.ny * c.basics.grid.pitch_m, 1e-12);
  EXPECT_EQ(coarse.grid.lead_m, c.basics.grid.lead_m);
  EXPECT_DOUBLE_EQ(fit_pitch(0.005, 0.002), 0.005 / 3);
}

TEST(LineConfig, OperatorInputsIgnoreWhatASliceCannotKnow) {
  const auto a = load(fake::config_text());
  const auto wide = load(fake::config_text(), {{"/slab/fired_width_mm", "200"}, {"/powders/0/colour", "\"#eeeeee\""}});
  const auto faster = load(fake::config_text(), {{"/belt_speed_m_s", "0.2"}});
  EXPECT_EQ(operator_inputs_json(a.basics), operator_inputs_json(wide.basics));
  EXPECT_NE(operator_inputs_json(a.basics), operator_inputs_json(faster.basics));
}

TEST(LineConfig, CrossFieldMistakes) {
  EXPECT_NE(refused(fake::config_text(), {{"/powders/1/granule_density_kg_m3", "1700"}}).find("granule densities differ"), std::string::npos);
  EXPECT_NE(refused(fake::config_text(), {{"/powders/1/role", "\"body\""}}).find("one powder with role body and one with role vein"),
            std::string::npos);
  EXPECT_NE(refused(fake::config_text(), {{"/powders/1/name", "\"white\""}}).find("two powders are called 'white'"), std::string::npos);
  EXPECT_NE(refused(fake::config_text(), {{"/powders/0/upper_cut_um", "100"}}).find("upper cut is below the lower cut"), std::string::npos);
  EXPECT_NE(refused(fake::config_text(), {{"/grid", R"({"pitch_mm":2})"}}).find("not a whole number of columns"), std::string::npos);
  EXPECT_NE(refused(fake::config_text(), {{"/vein_map", R"({"polish_depth_mm":12})"}}).find("takes off the whole slab"), std::string::npos);
}

TEST(LineConfig, AllMistakesAtOnce) {
  const auto text = refused(fake::config_text(), {{"/belt_speed_m_s", "7"}, {"/slab/fired_width_mm", "-1"}, {"/graphic/print_dpi", "\"many\""}});
  EXPECT_NE(text.find("/belt_speed_m_s"), std::string::npos);
  EXPECT_NE(text.find("/slab/fired_width_mm"), std::string::npos);
  EXPECT_NE(text.find("/graphic/print_dpi"), std::string::npos);
}

TEST(LineConfig, ImpossibleChains) {
  auto text = refused(fake::config_text(R"([{"stage":"squeeze"}])"));
  EXPECT_NE(text.find("/chain/0/stage"), std::string::npos) << text;
  EXPECT_NE(text.find("squeeze needs a full bed, but the chain starts with commands"), std::string::npos) << text;
  EXPECT_NE(text.find("dose"), std::string::npos) << "names what would fit";
  text = refused(fake::config_text(R"([{"stage":"dose"}])"));
  EXPECT_NE(text.find("makes a full bed, not a slab"), std::string::npos) << text;
  text = refused(fake::config_text(R"([{"stage":"dose"},{"stage":"dose"},{"stage":"squeeze"}])"));
  EXPECT_NE(text.find("/chain/1/stage"), std::string::npos) << text;
}

TEST(LineConfig, UnknownStageIsOneMistakeNotTwo) {
  const auto text = refused(fake::config_text(R"([{"stage":"dosse"},{"stage":"squeeze"}])"));
  EXPECT_NE(text.find("dosse"), std::string::npos);
  EXPECT_EQ(text.find("needs a full bed"), std::string::npos) << "the order is judged only when every stage is known";
}

TEST(LineConfig, ImageXorLayers) {
  EXPECT_NE(refused(fake::config_text(), {{"/graphic/layers", R"([{"image":"x.png"}])"}}).find("has both image and layers"), std::string::npos);
}

TEST(LineConfig, ResolvedConfigReadsBackToItself) {
  const auto c = load(fake::config_text());
  EXPECT_EQ(load(c.resolved_json).resolved_json, c.resolved_json);
}

TEST(LineConfig, DescribesAndHasASchema) {
  const auto stages = fake::stages();
  const auto root = line_config_root(stages);
  const auto text = describe_config_text(root);
  for (const char* key : {"belt_speed_m_s", "fired_width_mm", "darkness_threshold", "print_dpi", "speed_m_s", "correlation_mm"})
    EXPECT_NE(text.find(key), std::string::npos) << key;
  EXPECT_NE(config_json_schema(root, "venato-line").find("2020-12"), std::string::npos);
}

TEST(LineConfig, InksComeFromAProfileOrFromTheirSolidsButNotFromNothing) {
  const std::string graphic = std::string(R"({"image":")") + VENATO_SOURCE_DIR + R"(/configs/images/pov_calacatta_1600x3200.jpg","pitch_mm":1)";
  const std::string profile =
      std::string(R"(,"profile":")") + VENATO_SOURCE_DIR + R"(/configs/images/pov_calacatta_1600x3200.jpg")";  // any file: not read here
  const std::string inks = R"(,"inks":[{"name":"black","solid":"#202020"}])", body = R"(,"body_colour":"#f0f0f0")";
  const auto with = [&](const std::string& more) { return std::vector<Override>{{"/graphic", graphic + more + "}"}}; };
  const auto none = refused(fake::config_text(), with(""));
  EXPECT_NE(none.find("/graphic/inks: colours cannot become inks"), std::string::npos) << none;
  EXPECT_NE(none.find("ICC output profile"), std::string::npos) << "tells what to supply";
  EXPECT_NE(refused(fake::config_text(), with(inks)).find("/graphic/body_colour is missing"), std::string::npos);
  EXPECT_NE(refused(fake::config_text(), with(profile + inks + body)).find("has both a profile and inks"), std::string::npos);
  EXPECT_NE(refused(fake::config_text(), with(profile + body)).find("the profile tells the colour of the body"), std::string::npos);
  const auto c = load(fake::config_text(), with(profile + R"(,"profile_intent":"saturation")"));
  EXPECT_EQ(c.graphic.profile_intent, graphics::RenderingIntent::saturation);
  EXPECT_TRUE(c.graphic.inks.empty());
  EXPECT_FALSE(load_line_config_text(c.resolved_json, "/", {}, fake::stages()).graphic.profile.empty()) << "what a run writes can be read again";
  EXPECT_EQ(load(fake::config_text(), with(inks + body)).graphic.body_colour[0], 0xf0);
}
}  // namespace
}  // namespace venato::line
