#include <gtest/gtest.h>

#include <fstream>

#include "base/config/object_reader.h"
#include "base/error.h"
#include "tests/base/temp_folder.h"

// Every kind of mistake a user can make in a file, with the text that is shown for it: the messages are part of the product.
namespace venato {
namespace {

enum class Kind { vibratory, rotary };
struct Config {
  double peak_pressure_pa = -1, dwell_s = -1, belt_speed_m_s = -1;
  int prongs = -1;
  Kind kind = Kind::vibratory;
  std::uint64_t seed = 0;
  bool mirrored = false;
  std::string text, name;
  Rgb8 colour{};
  std::vector<double> list, table;
};

std::vector<std::string> mistakes_of(std::string_view json, const ReadRoot& root) {
  std::vector<std::string> lines;
  for (const ConfigIssue& issue : read_config_text(json, ".", {}, root).issues) lines.push_back(format_issue(issue));
  return lines;
}
using Lines = std::vector<std::string>;

void read_press(ObjectReader& r, Config& c) {
  r.number("peak_pressure_mpa", c.peak_pressure_pa, {5, 60, "MPa", "press rating"});
  r.number("dwell_s", c.dwell_s, {0, 10, "s"});
}
Lines press_mistakes(std::string_view press) {
  Config c;
  return mistakes_of("{\"press\":" + std::string(press) + "}",
                     [&](ObjectReader& r) { r.object("press", "the press", [&](ObjectReader& p) { read_press(p, c); }); });
}
}  // namespace

TEST(Mistakes, OutsideRange) {
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":450,"dwell_s":0})"), Lines{"/press/peak_pressure_mpa: 450 is outside [5, 60] MPa (press rating)"});
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":60.00000001,"dwell_s":-1e-9})"),
            (Lines{"/press/peak_pressure_mpa: 60.00000001 is outside [5, 60] MPa (press rating)", "/press/dwell_s: -1e-09 is outside [0, 10] s"}));
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":60,"dwell_s":10})"), Lines{});
}

TEST(Mistakes, Missing) {
  EXPECT_EQ(press_mistakes(R"({"dwell_s":0})"), Lines{"/press/peak_pressure_mpa is missing (no hidden defaults)"});
  Config c;
  EXPECT_EQ(mistakes_of("{}", [&](ObjectReader& r) { r.object("press", "", [&](ObjectReader& p) { read_press(p, c); }); }),
            Lines{"/press is missing (no hidden defaults)"});
}

TEST(Mistakes, WrongType) {
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":30,"dwell_s":"0.5"})"),
            Lines{"/press/dwell_s must be a number, is string \"0.5\"; did you mean 0.5?"});
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":30,"dwell_s":"fast"})"), Lines{"/press/dwell_s must be a number, is string \"fast\""});
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":[30],"dwell_s":null})"),
            (Lines{"/press/peak_pressure_mpa must be a number, is array", "/press/dwell_s must be a number, is null"}));
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":30,"dwell_s":true})"), Lines{"/press/dwell_s must be a number, is boolean true"});
  EXPECT_EQ(press_mistakes("[1]"), Lines{"/press must be an object, is array"});
  EXPECT_EQ(mistakes_of("[1]", [](ObjectReader&) {}), Lines{"the file must hold an object { … }, is array"});
}

TEST(Mistakes, UnknownKeyBothSides) {
  EXPECT_EQ(press_mistakes(R"({"peak_presure_mpa":30,"dwell_s":1})"),
            (Lines{"/press/peak_pressure_mpa is missing (no hidden defaults)",
                   "/press/peak_presure_mpa is not a known key; did you mean 'peak_pressure_mpa'? (in MPa)"}));
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":30,"dwell_s":1,"colour_of_the_operator":1})"),
            Lines{"/press/colour_of_the_operator is not a known key; known keys: peak_pressure_mpa, dwell_s"});
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":30,"dwell_s":1,"a/b~c":1})"),
            Lines{"/press/a~1b~0c is not a known key; known keys: peak_pressure_mpa, dwell_s"});
}

TEST(Mistakes, WrongUnitSuffixSuggestsTheRightKey) {
  Config c;
  const ReadRoot root = [&](ObjectReader& r) {
    r.number("belt_speed_m_s", c.belt_speed_m_s, {0, 2, "m/s"});
    r.number("belt_width_mm", c.dwell_s, {0, 5000, "mm"});
  };
  EXPECT_EQ(mistakes_of(R"({"belt_speed_mm_s":300,"belt_width":1800})", root),
            (Lines{"/belt_speed_m_s is missing (no hidden defaults)", "/belt_width_mm is missing (no hidden defaults)",
                   "/belt_speed_mm_s is not a known key; did you mean 'belt_speed_m_s'? (in m/s)",
                   "/belt_width is not a known key; did you mean 'belt_width_mm'? (in mm)"}));
}

TEST(Mistakes, DuplicateKey) {
  EXPECT_EQ(press_mistakes(R"({"peak_pressure_mpa":30,"dwell_s":1,"dwell_s":2})"), Lines{"/press/dwell_s is given twice; keep one of the two"});
}

TEST(Mistakes, SyntaxHasLineAndColumn) {
  const auto lines = mistakes_of("{\n  \"a\": 1,\n  \"b\": }\n", [](ObjectReader&) {});
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].rfind("line 3, column 8: syntax error", 0), 0u) << lines[0];
  for (const char* text : {"", "{", "{\"a\":1} x", "{'a':1}", "{\"a\":1,}", "// c\n{}", "{\"a\":01}", "{\"a\":\"\xff\"}"}) {
    const auto bad = mistakes_of(text, [](ObjectReader&) {});
    ASSERT_EQ(bad.size(), 1u) << text;
    EXPECT_EQ(bad[0].rfind("line ", 0), 0u) << bad[0];
  }
}

TEST(Mistakes, NumbersThatAreNone) {
  const auto said = [](const char* value) { return press_mistakes("{\"dwell_s\": " + std::string(value) + "}"); };
  EXPECT_EQ(said("NaN"), Lines{"/press/dwell_s: line 1, column 22: NaN is not a JSON number; give a finite number"});
  EXPECT_EQ(said("-Infinity"), Lines{"/press/dwell_s: line 1, column 23: -Infinity is not a JSON number; give a finite number"});
  const auto overflow = said("1e999");
  ASSERT_EQ(overflow.size(), 1u);
  EXPECT_EQ(overflow[0].rfind("/press/dwell_s: line 1, column ", 0), 0u) << overflow[0];
  EXPECT_NE(overflow[0].find("1e999 is beyond the range of numbers"), std::string::npos) << overflow[0];
}

TEST(Mistakes, TooDeepAndTooLarge) {
  const auto nothing = [](ObjectReader&) {};
  const std::string deep = "{\"a\":" + std::string(100000, '[') + std::string(100000, ']') + "}";
  EXPECT_EQ(mistakes_of(deep, nothing), Lines{"the file is nested deeper than 64 levels"});
  EXPECT_EQ(mistakes_of("{\"a\":\"" + std::string(5u << 20, 'x') + "\"}", nothing), Lines{"the file has 5242888 bytes, the limit is 4194304 bytes"});
  TempFolder folder;
  std::ofstream(folder / "big.json") << std::string(5u << 20, ' ');
  EXPECT_THROW(read_config_file(folder / "big.json", {}, nothing), UsageError);
  EXPECT_THROW(read_config_file(folder / "none.json", {}, nothing), UsageError);
}

TEST(Mistakes, WholeNumbersAndSeeds) {
  Config c;
  const ReadRoot root = [&](ObjectReader& r) {
    r.integer("prongs", c.prongs, {1, 500, ""});
    r.seed("seed", c.seed);
  };
  EXPECT_EQ(mistakes_of(R"({"prongs":1.5,"seed":-1})", root),
            (Lines{"/prongs must be a whole number, is 1.5", "/seed must be a whole number in [0, 18446744073709551615], is -1"}));
  EXPECT_EQ(mistakes_of(R"({"prongs":"7","seed":"5"})", root),
            (Lines{"/prongs must be a whole number, is string \"7\"; did you mean 7?",
                   "/seed must be a whole number in [0, 18446744073709551615], is string \"5\"; did you mean 5?"}));
  EXPECT_EQ(mistakes_of(R"({"prongs":99999999999999999999,"seed":1e300})", root),
            (Lines{"/prongs: 1e+20 is outside [1, 500]", "/seed must be a whole number in [0, 18446744073709551615], is 1e+300"}));
  EXPECT_EQ(mistakes_of(R"({"prongs":3.0,"seed":18446744073709551615})", root), Lines{});
  EXPECT_EQ(c.prongs, 3);
  EXPECT_EQ(c.seed, 18446744073709551615ull);
}

TEST(Mistakes, TextsNamesColoursChoicesBooleans) {
  Config c;
  const ReadRoot root = [&](ObjectReader& r) {
    r.choice("kind", c.kind, {{"vibratory", Kind::vibratory}, {"rotary", Kind::rotary}});
    r.boolean("mirrored", c.mirrored);
    r.text("text", c.text);
    r.name("name", c.name);
    r.colour("colour", c.colour);
  };
  EXPECT_EQ(mistakes_of(R"({"kind":"rotory","mirrored":1,"text":5,"name":"../etc","colour":"ff8000"})", root),
            (Lines{"/kind 'rotory' is not one of: vibratory, rotary; did you mean 'rotary'?",
                   "/mirrored must be true or false, is number 1; did you mean true?", "/text must be a string, is number 5",
                   "/name: \"../etc\" is not a name: 1 to 40 of the characters A-Z a-z 0-9 _ - (it goes into file names)",
                   "/colour: \"ff8000\" is not a colour \"#rrggbb\"; did you mean \"#ff8000\"?"}));
  EXPECT_EQ(mistakes_of(R"({"kind":"rotary","mirrored":"true","text":"","name":"","colour":"#ff80zz"})", root),
            (Lines{"/mirrored must be true or false, is string \"true\"; did you mean true?",
                   "/name: \"\" is not a name: 1 to 40 of the characters A-Z a-z 0-9 _ - (it goes into file names)",
                   "/colour: \"#ff80zz\" is not a colour \"#rrggbb\""}));
}

TEST(Mistakes, Lists) {
  Config c;
  const ReadRoot root = [&](ObjectReader& r) {
    r.numbers("list_mm", c.list, {0, 10, "mm"}, 1, 3);
    r.tuples("table", c.table, 2, {0, 10, ""}, 1, 3);
  };
  EXPECT_EQ(mistakes_of(R"({"list_mm":[],"table":[[1]]})", root),
            (Lines{"/list_mm must have at least 1 number, has 0", "/table/0 must be a list of 2 numbers, has 1"}));
  EXPECT_EQ(mistakes_of(R"({"list_mm":[1,20,"3",4],"table":[[1,2],[3,40],5]})", root),
            (Lines{"/list_mm must have at most 3 numbers, has 4", "/list_mm/1: 20 is outside [0, 10] mm",
                   "/list_mm/2 must be a number, is string \"3\"; did you mean 3?", "/table/1/1: 40 is outside [0, 10]",
                   "/table/2 must be a list of 2 numbers, is number 5"}));
  EXPECT_EQ(mistakes_of(R"({"list_mm":1,"table":1})", root),
            (Lines{"/list_mm must be a list of numbers, is number 1", "/table must be a list, each item a list of 2 numbers, is number 1"}));
}

TEST(Mistakes, ObjectsAndUnions) {
  const ReadRoot root = [](ObjectReader& r) {
    r.objects("chain", "stages", 1, 2, [](ObjectReader& stage, std::size_t) {
      double x = 0;
      stage.pick("stage", "which",
                 {{"press", "",
                   [&](ObjectReader& p) {
                     p.number("peak_pressure_mpa", x, {5, 60, "MPa"});
                   }},
                  {"belt", "", [&](ObjectReader& b) {
                     b.number("speed_m_s", x, {0, 2, "m/s"});
                   }}});
    });
  };
  EXPECT_EQ(
      mistakes_of(R"({"chain":[{"stage":"belt","peak_pressure_mpa":30}]})", root),
      (Lines{"/chain/0/speed_m_s is missing (no hidden defaults)", "/chain/0/peak_pressure_mpa is not a known key; known keys: stage, speed_m_s"}));
  // An unknown branch: its keys cannot be judged, one line is enough.
  EXPECT_EQ(mistakes_of(R"({"chain":[{"stage":"pres","peak_pressure_mpa":30}]})", root),
            Lines{"/chain/0/stage 'pres' is not one of: press, belt; did you mean 'press'?"});
  EXPECT_EQ(mistakes_of(R"({"chain":[{"peak_pressure_mpa":30},7]})", root),
            (Lines{"/chain/0/stage is missing (no hidden defaults)", "/chain/1 must be an object, is number 7"}));
  EXPECT_EQ(mistakes_of(R"({"chain":[]})", root), Lines{"/chain must have 1 to 2 items, has 0"});
  EXPECT_EQ(mistakes_of(R"({"chain":{}})", root), Lines{"/chain must be a list of objects, is object"});
}

TEST(Mistakes, Paths) {
  TempFolder folder;
  std::ofstream(folder / "veins.png") << "x";
  std::filesystem::create_directory(folder / "sub");
  std::filesystem::path out;
  const auto said = [&](const std::string& value) {
    const auto outcome =
        read_config_text("{\"image\":\"" + value + "\"}", folder.path(), {}, [&](ObjectReader& r) { r.path("image", out, PathKind::existing_file); });
    return outcome.ok() ? "" : format_issue(outcome.issues.at(0));
  };
  EXPECT_EQ(said("veins.png"), "");
  EXPECT_EQ(out, folder / "veins.png");
  EXPECT_EQ(said("viens.png"), "/image 'viens.png' is not a file (looked for " + (folder / "viens.png").string() + "); did you mean 'veins.png'?");
  EXPECT_EQ(said("sub"), "/image 'sub' is not a file (looked for " + (folder / "sub").string() + ", which is a folder)");
  EXPECT_EQ(said(""), "/image must be a path, is \"\"");
  EXPECT_EQ(out, folder / "veins.png");  // a mistake leaves the member alone
}

TEST(Mistakes, CrossFieldIssueAndAllAtOnce) {
  const auto lines = mistakes_of(R"({"low":3,"high":2,"extra":1,"name":5})", [](ObjectReader& r) {
    double low = 0, high = 0;
    std::string name;
    r.number("low", low, {0, 10, ""});
    r.number("high", high, {0, 10, ""});
    r.name("name", name);
    if (low > high) r.issue("high", "is below low (3)", "swap the two");
    r.issue("", "has a general problem");
  });
  EXPECT_EQ(lines, (Lines{"/name must be a string, is number 5", "/high is below low (3); swap the two", "the file has a general problem",
                          "/extra is not a known key; known keys: low, high, name"}));
}
}  // namespace venato
