#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/config/json_parse.h"
#include "base/config/object_reader.h"
#include "base/config/suggest.h"
#include "base/error.h"
#include "tests/base/temp_folder.h"

namespace venato {
namespace {
struct Line {
  double pressure_pa = 0, speed_m_s = 0, width_m = 0;
  std::vector<double> polyline_m;
  int prongs = 0;
  bool mirrored = false, has_glaze = false;
  std::string name;
  Rgb8 colour{};
  std::uint64_t seed = 0;
  std::filesystem::path image, none;
  std::vector<std::string> stages;
};

void read_line(ObjectReader& r, Line& c) {
  r.seed("seed", c.seed, {.help = "run seed"});
  r.object(
      "press", "the press",
      [&](ObjectReader& p) {
        p.number("peak_pressure_mpa", c.pressure_pa, {5, 60, "MPa", "press rating"},
                 {.help = "specific pressure at the face", .fallback = 40, .placeholder = true});
      },
      false);
  r.number("belt_speed_m_min", c.speed_m_s, {0, 60, "m/min"}, {.fallback = 18});
  r.number("belt_width_mm", c.width_m, {100, 5000, "mm"});
  r.tuples("edge_mm", c.polyline_m, 2, {-1e4, 1e4, "mm"}, 2, 100, {.fallback = std::vector<double>{0, 0, 100, 50}});
  r.integer("prongs", c.prongs, {1, 500, ""}, {.fallback = 120, .placeholder = true});
  r.boolean("mirrored", c.mirrored, {.fallback = false});
  r.name("name", c.name, {.fallback = "demo"});
  r.colour("colour", c.colour, {.fallback = "#ff8000"});
  r.path("image", c.image, PathKind::any);
  r.path("profile", c.none, PathKind::existing_file, {.fallback = ""});
  c.has_glaze = r.optional_object("glaze", "second print", [&](ObjectReader& g) {
    double x = 0;
    g.number("offset_mm", x, {0, 5, "mm"});
  });
  r.objects("chain", "the stages", 0, 5, [&](ObjectReader& s, std::size_t) {
    s.pick("stage", "which stage",
           {{"press", "presses", [&](ObjectReader&) { c.stages.push_back("press"); }}, {"belt", "carries", [&](ObjectReader& b) {
                                                                                          c.stages.push_back("belt");
                                                                                          double length = 0;
                                                                                          b.number("length_m", length, {0, 20, "m"});
                                                                                        }}});
  });
}
ReadOutcome read(std::string_view json, Line& line, const std::vector<Override>& overrides = {}) {
  return read_config_text(json, "/base", overrides, [&](ObjectReader& r) { read_line(r, line); });
}
constexpr std::string_view kMinimal = R"({"$schema":"x.json","seed":7,"belt_width_mm":1800,"image":"a/../b.png"})";
}  // namespace

TEST(Reader, ConvertsToSiAndFillsFallbacks) {
  Line c;
  const ReadOutcome o = read(kMinimal, c);
  ASSERT_TRUE(o.ok()) << format_issue(o.issues.at(0));
  EXPECT_EQ(c.seed, 7u);
  EXPECT_EQ(c.pressure_pa, 40e6);
  EXPECT_EQ(c.width_m, 1800 * 1e-3);
  EXPECT_NEAR(c.speed_m_s, 0.3, 1e-16);  // one rounding of 18 / 60
  EXPECT_EQ(c.polyline_m, (std::vector<double>{0, 0, 100 * 1e-3, 50 * 1e-3}));
  EXPECT_EQ(c.prongs, 120);
  EXPECT_EQ(c.colour, (Rgb8{255, 128, 0}));
  EXPECT_EQ(c.image, "/base/b.png");
  EXPECT_TRUE(c.none.empty());
  EXPECT_FALSE(c.has_glaze);
  EXPECT_TRUE(c.stages.empty());
}

TEST(Reader, ResolvedJsonIsCanonicalAndReadsBackTheSame) {
  Line c, again;
  const ReadOutcome o = read(kMinimal, c);
  EXPECT_EQ(o.resolved_json,
            R"({"belt_speed_m_min":18,"belt_width_mm":1800,"chain":[],"colour":"#ff8000","edge_mm":[[0,0],[100,50]],"image":"a/../b.png",)"
            R"("mirrored":false,"name":"demo","press":{"peak_pressure_mpa":40},"profile":"","prongs":120,"seed":7})");
  const ReadOutcome second = read(o.resolved_json, again);
  EXPECT_TRUE(second.ok());
  EXPECT_EQ(second.resolved_json, o.resolved_json);
  EXPECT_EQ(o.subtree("/press"), R"({"peak_pressure_mpa":40})");
  EXPECT_EQ(o.subtree("/edge_mm/1/0"), "100");
  EXPECT_THROW(o.subtree("/nothing"), std::logic_error);
}

// A hash of the config must not see how a number is spelt.
TEST(Reader, SpellingOfNumbersDoesNotMatter) {
  Line c;
  const std::string a = read(R"({"image":"x","seed":7,"belt_width_mm":1.8e3,"prongs":3.0,"belt_speed_m_min":0.1})", c).resolved_json;
  const std::string b = read(R"({"belt_width_mm":1800.0,"belt_speed_m_min":1e-1,"prongs":3,"seed":7,"image":"x"})", c).resolved_json;
  EXPECT_EQ(a, b);
  EXPECT_NE(a.find("\"belt_speed_m_min\":0.1,"), std::string::npos);
}

TEST(Reader, Placeholders) {
  Line c;
  const ReadOutcome o = read(kMinimal, c);
  ASSERT_EQ(o.placeholders.size(), 2u);
  EXPECT_EQ(o.placeholders[0].pointer, "/press/peak_pressure_mpa");
  EXPECT_EQ(o.placeholders[0].value, "40");
  EXPECT_EQ(o.placeholders[0].unit, "MPa");
  const ReadOutcome own = read(R"({"seed":7,"belt_width_mm":1800,"image":"x","press":{"peak_pressure_mpa":38.5},"prongs":120})", c);
  ASSERT_EQ(own.placeholders.size(), 1u);  // the user's own pressure is none any more; 120 prongs is still our number
  EXPECT_EQ(own.placeholders[0].pointer, "/prongs");
}

TEST(Reader, Overrides) {
  Line c;
  const ReadOutcome o = read(R"({"seed":7,"belt_width_mm":1800,"image":"x","chain":[{"stage":"belt","length_m":3}]})", c,
                             {parse_override("/press/peak_pressure_mpa=33.5"), parse_override("/chain/0/length_m=4"), parse_override("/name=other=1"),
                              parse_override("/seed=8")});
  ASSERT_EQ(o.issues.size(), 1u);  // "other=1" is a string but no name
  EXPECT_EQ(o.issues[0].pointer, "/name");
  EXPECT_EQ(c.pressure_pa, 33.5e6);
  EXPECT_EQ(c.seed, 8u);
  EXPECT_EQ(o.subtree("/chain/0/length_m"), "4");
}

TEST(Reader, OverridesThatCannotBeApplied) {
  Line c;
  const ReadOutcome o = read(kMinimal, c, {parse_override("/seed/x=1"), parse_override("/pres/peak_pressure_mpa=30")});
  ASSERT_EQ(o.issues.size(), 2u);
  EXPECT_EQ(format_issue(o.issues[0]), "/seed/x: --set: cannot go below a number");
  EXPECT_EQ(format_issue(o.issues[1]), "/pres is not a known key; did you mean 'press'?");
  const ReadOutcome list = read(R"({"seed":7,"belt_width_mm":1800,"image":"x","chain":[]})", c, {parse_override("/chain/3/stage=press")});
  ASSERT_EQ(list.issues.size(), 1u);
  EXPECT_EQ(format_issue(list.issues[0]), "/chain/3/stage: --set: '3' is not an index of a list with 0 items");
  for (const char* bad : {"", "=", "/=3", "press=3", "/press"}) EXPECT_THROW(parse_override(bad), UsageError) << bad;
}

TEST(Reader, FileAndErrorList) {
  TempFolder folder;
  std::ofstream(folder / "c.json") << R"({"seed":7,"image":"x.png"})";
  Line c;
  const ReadOutcome o = read_config_file(folder / "c.json", {}, [&](ObjectReader& r) { read_line(r, c); });
  EXPECT_EQ(c.image, folder / "x.png");
  try {
    o.throw_if_bad();
    FAIL() << "must throw";
  } catch (const ConfigError& e) {
    EXPECT_EQ(e.what(), (folder / "c.json").string() + ": 1 mistake\n  /belt_width_mm is missing (no hidden defaults)");
  }
}

TEST(Describe, TableNamesEveryKeyWithUnitRangeDefaultHelp) {
  Line c;
  const std::string text = describe_config_text([&](ObjectReader& r) { read_line(r, c); });
  for (const char* part :
       {"/seed\n    whole number in [0, 2^64); required\n    run seed\n",
        "/press/peak_pressure_mpa\n    number in [5, 60] MPa (press rating); default 40; PLACEHOLDER (no public source for this number)\n"
        "    specific pressure at the face\n",
        "/belt_width_mm\n    number in [100, 5000] mm; required\n", "/edge_mm\n    list of [2 numbers], 2 to 100 items in [-10000, 10000] mm",
        "/glaze/offset_mm\n", "/chain/N/stage\n    one of: press, belt; required\n", "/chain/N/stage = \"belt\"\n    carries\n/chain/N/length_m\n",
        "/colour\n    colour \"#rrggbb\"; default \"#ff8000\"\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nnot in\n" << text;
}

TEST(Describe, SchemaIsValidJsonWithLimitsAndBranches) {
  Line c;
  const auto s = nlohmann::json::parse(config_json_schema([&](ObjectReader& r) { read_line(r, c); }, "venato line"));
  EXPECT_EQ(s["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(s["title"], "venato line");
  EXPECT_EQ(s["required"], (nlohmann::json{"seed", "belt_width_mm", "image"}));
  EXPECT_EQ(s["unevaluatedProperties"], false);
  const auto& press = s["properties"]["press"]["properties"]["peak_pressure_mpa"];
  EXPECT_EQ(press["minimum"], 5);
  EXPECT_EQ(press["maximum"], 60);
  EXPECT_EQ(press["default"], 40);
  const auto& stage = s["properties"]["chain"]["items"];
  EXPECT_EQ(stage["properties"]["stage"]["enum"], (nlohmann::json{"press", "belt"}));
  EXPECT_EQ(stage["allOf"].size(), 2u);
  EXPECT_EQ(stage["allOf"][1]["if"]["properties"]["stage"]["const"], "belt");
  EXPECT_EQ(stage["allOf"][1]["then"]["required"], nlohmann::json{"length_m"});
  EXPECT_EQ(s["properties"]["edge_mm"]["items"]["minItems"], 2);
  EXPECT_TRUE(s["properties"].contains("$schema"));
}

TEST(Describe, VisitsWithoutTouchingIssuesOrFiles) {
  bool saw_describing = false;
  const std::string text = describe_config_text([&](ObjectReader& r) {
    saw_describing = r.describing();
    EXPECT_FALSE(r.has("a"));
    std::filesystem::path p;
    r.path("a", p, PathKind::existing_file);
    r.issue("a", "is ignored here");
  });
  EXPECT_TRUE(saw_describing);
  EXPECT_EQ(text, "/a\n    path; required\n");
}

TEST(JsonText, NumbersReadBackExactly) {
  for (const double v : {0.1, 1.0 / 3, 1e-300, 1.7976931348623157e308, 123456789.125, -2.5e-7, 1e15, 999999999999999.0, 5e-324})
    EXPECT_EQ(std::strtod(number_text(v).c_str(), nullptr), v) << number_text(v);
  EXPECT_EQ(number_text(-0.0), "0");
  EXPECT_EQ(number_text(1e22), "1e+22");
  EXPECT_EQ(number_text(1800.0), "1800");
  EXPECT_EQ(json_quoted("a\"\\\n\x01ü"), "\"a\\\"\\\\\\n\\u0001ü\"");
}

// Property: what we print is what the JSON library reads, and what we parse is what it means.
TEST(JsonText, AgreesWithTheLibrary) {
  const std::string text = R"({"a":[1,-2,3.5,1e-9,true,null,"xü\n"],"b":{"c":{}},"big":18446744073709551615})";
  const JsonParse parsed = parse_json(text);
  ASSERT_TRUE(parsed.usable && parsed.issues.empty());
  EXPECT_EQ(nlohmann::json::parse(to_text(parsed.value)), nlohmann::json::parse(text));
  EXPECT_EQ(nlohmann::json::parse(to_text(parsed.value, 2)), nlohmann::json::parse(text));
}

TEST(Suggest, DistanceAndNearest) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("viens", "veins"), 1);  // swapped neighbours
  const std::vector<std::string> keys = {"belt_speed_m_s", "belt_width_mm", "kind"};
  EXPECT_EQ(nearest("belt_speed_mm_s", keys), "belt_speed_m_s");
  EXPECT_EQ(nearest("beltspeed_m_s", keys), "belt_speed_m_s");
  EXPECT_EQ(nearest("Belt-Width-MM", keys), "belt_width_mm");
  EXPECT_EQ(nearest("temperature_k", keys), "");
  EXPECT_EQ(nearest("x", keys), "");
}
}  // namespace venato
