#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/structure/source_tree.h"

// design.md, section 3: who may know whom; house style 2 and 3: library headers stay in files named for them, files stay small.
namespace venato::structure {
namespace {

using Problems = std::vector<std::string>;

const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"base", {"base"}},
    {"dem", {"base", "dem"}},
    {"graphics", {"base", "graphics"}},
    {"sync", {"base", "graphics", "sync"}},
    {"line", {"base", "dem", "graphics", "sync", "line"}},
};

/// tests/<module>/ may know what <module> may; tests/structure and tests/e2e look at everything.
std::set<std::string> allowed_tops(const std::string& path) {
  const std::string top = top_of(path);
  if (top != "tests") return kMayInclude.at(top);
  const std::string module = top_of(path.substr(top.size() + 1));
  const auto it = kMayInclude.find(module);
  std::set<std::string> allowed = it != kMayInclude.end() ? it->second : kMayInclude.at("line");
  allowed.insert("tests");
  return allowed;
}

void check_layers(const SourceFile& file, Problems& problems) {
  const std::set<std::string> allowed = allowed_tops(file.path);
  for (const Include& include : includes_of(file)) {
    if (!include.quoted) continue;
    const bool generated = ends_with(include.target, ".inc") && include.target.find('/') == std::string::npos;
    if (generated) continue;
    const std::string top = top_of(include.target);
    if (include.target.find('/') == std::string::npos || include.target.find("..") != std::string::npos)
      problems.push_back(file.path + ": \"" + include.target + "\" is not a path from the repository root");
    else if (!allowed.contains(top))
      problems.push_back(file.path + ": must not know \"" + include.target + "\"");
  }
}

struct Confinement {
  std::vector<std::string> prefixes;  ///< of the included header
  std::string suffix;                 ///< of the file's stem
  bool private_headers;               ///< "x<suffix>.h" is fine when only files of that suffix include it
};
const std::vector<Confinement> kConfined = {
    {{"nlohmann/"}, "_json", false},
    {{"hdf5.h", "hdf5_hl.h", "H5"}, "_h5", true},
    {{"opencv2/", "opencv4/"}, "_cv", false},
    {{"tiff.h", "tiffio.h", "tiffio.hxx"}, "_tiff", true},
    {{"lcms2.h", "lcms2_plugin.h"}, "_lcms", true},
};

/// Libraries that one folder or file owns.
const std::vector<std::pair<std::string, std::string>> kOwned = {
    {"spdlog/", "base/progress.cpp"}, {"openssl/", "base/io/sha256.cpp"}, {"CLI/", "line/app/"}, {"assimp/", "dem/"}};

void check_confinement(const SourceFile& file, Problems& problems) {
  if (top_of(file.path) == "tests") return;
  const auto named_for = [&](const Confinement& c) {
    return ends_with(file.path, c.suffix + ".cpp") || (c.private_headers && ends_with(file.path, c.suffix + ".h"));
  };
  for (const Include& include : includes_of(file)) {
    for (const Confinement& c : kConfined) {
      bool confined = include.quoted && ends_with(include.target, c.suffix + ".h");
      for (const std::string& prefix : c.prefixes) confined |= !include.quoted && include.target.rfind(prefix, 0) == 0;
      if (confined && !named_for(c)) problems.push_back(file.path + ": " + include.target + " belongs into *" + c.suffix + ".cpp");
    }
    for (const auto& [prefix, owner] : kOwned)
      if (include.target.rfind(prefix, 0) == 0 && file.path.rfind(owner, 0) != 0)
        problems.push_back(file.path + ": " + include.target + " belongs into " + owner);
  }
}

void check_length(const SourceFile& file, Problems& problems) {
  constexpr std::size_t kHardStop = 700, kHeaderStop = 200;
  const std::size_t limit = ends_with(file.path, ".h") ? kHeaderStop : kHardStop;
  const std::size_t lines = line_count(file.text);
  if (lines > limit) problems.push_back(file.path + ": has " + std::to_string(lines) + " lines, the limit is " + std::to_string(limit));
}

/// Results must not depend on a generator with hidden state, the clock or the library's own random numbers.
void check_randomness(const SourceFile& file, Problems& problems) {
  static const std::regex kBanned(
      "std::rand\\b|\\bsrand\\(|std::random_device|std::mt19937|std::minstd_rand|std::default_random_engine|\\bdrand48\\(|cv::theRNG");
  if (top_of(file.path) == "tests") return;
  std::smatch match;
  if (std::regex_search(file.text, match, kBanned)) problems.push_back(file.path + ": " + match.str() + " (use base/rng.h)");
}

Problems problems_of(const std::vector<SourceFile>& files) {
  Problems problems;
  for (const SourceFile& file : files) {
    check_layers(file, problems);
    check_confinement(file, problems);
    check_length(file, problems);
    check_randomness(file, problems);
  }
  return problems;
}
}  // namespace

TEST(Layering, TheTreeKeepsTheRules) {
  const std::vector<SourceFile> files = read_sources(VENATO_SOURCE_DIR);
  ASSERT_GT(files.size(), 40u);  // the scan really found the tree
  for (const std::string& problem : problems_of(files)) ADD_FAILURE() << problem;
}

TEST(Layering, EveryModuleOfTheTableExists) {
  for (const auto& [module, allowed] : kMayInclude)
    EXPECT_TRUE(std::filesystem::is_directory(std::filesystem::path(VENATO_SOURCE_DIR) / module)) << module;
}

// Negative controls: each rule must really refuse.
struct Sample {
  const char* path;
  std::string text;
  const char* expected;  ///< "" = no problem
};

class LayeringRule : public ::testing::TestWithParam<Sample> {};
TEST_P(LayeringRule, AnswersAsExpected) {
  const Sample& s = GetParam();
  const Problems problems = problems_of({{s.path, s.text}});
  const std::string all = problems.empty() ? "" : problems.front();
  EXPECT_EQ(all, s.expected);
  EXPECT_LE(problems.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Samples, LayeringRule,
    ::testing::Values(
        Sample{"dem/a.cpp", "#include \"base/rng.h\"\n#include \"dem/b.h\"\n", ""}, Sample{"sync/a.cpp", "#include \"graphics/a.h\"\n", ""},
        Sample{"line/a.cpp", "#include \"dem/a.h\"\n#include \"sync/a.h\"\n#include \"line_stages_list.inc\"\n", ""},
        Sample{"base/a.cpp", "#include \"dem/a.h\"\n", "base/a.cpp: must not know \"dem/a.h\""},
        Sample{"dem/a.cpp", "  #  include \"graphics/a.h\"\n", "dem/a.cpp: must not know \"graphics/a.h\""},
        Sample{"graphics/a.cpp", "#include \"sync/a.h\"\n", "graphics/a.cpp: must not know \"sync/a.h\""},
        Sample{"sync/a.h", "#include \"dem/a.h\"\n", "sync/a.h: must not know \"dem/a.h\""},
        Sample{"sync/a.h", "#include \"line/a.h\"\n", "sync/a.h: must not know \"line/a.h\""},
        Sample{"tests/dem/a_test.cpp", "#include \"line/a.h\"\n", "tests/dem/a_test.cpp: must not know \"line/a.h\""},
        Sample{"tests/dem/a_test.cpp", "#include <nlohmann/json.hpp>\n#include \"tests/base/temp_folder.h\"\n", ""},
        Sample{"dem/a.cpp", "#include \"b.h\"\n", "dem/a.cpp: \"b.h\" is not a path from the repository root"},
        Sample{"dem/a.cpp", "#include \"../line/b.h\"\n", "dem/a.cpp: \"../line/b.h\" is not a path from the repository root"},
        Sample{"line/a_json.cpp", "#include <nlohmann/json.hpp>\n", ""},
        Sample{"line/a.cpp", "#include <nlohmann/json.hpp>\n", "line/a.cpp: nlohmann/json.hpp belongs into *_json.cpp"},
        Sample{"line/a_json.h", "#include <nlohmann/json.hpp>\n", "line/a_json.h: nlohmann/json.hpp belongs into *_json.cpp"},
        Sample{"line/a.cpp", "#include <hdf5.h>\n", "line/a.cpp: hdf5.h belongs into *_h5.cpp"}, Sample{"line/a_h5.h", "#include <hdf5.h>\n", ""},
        Sample{"line/a.cpp", "#include \"line/a_h5.h\"\n", "line/a.cpp: line/a_h5.h belongs into *_h5.cpp"},
        Sample{"sync/a_cv.cpp", "#include <opencv2/core.hpp>\n", ""},
        Sample{"sync/a_cv.h", "#include <opencv2/core.hpp>\n", "sync/a_cv.h: opencv2/core.hpp belongs into *_cv.cpp"},
        Sample{"graphics/a.cpp", "#include <tiffio.h>\n", "graphics/a.cpp: tiffio.h belongs into *_tiff.cpp"},
        Sample{"graphics/a.cpp", "#include <lcms2.h>\n", "graphics/a.cpp: lcms2.h belongs into *_lcms.cpp"},
        Sample{"dem/a.cpp", "#include <spdlog/spdlog.h>\n", "dem/a.cpp: spdlog/spdlog.h belongs into base/progress.cpp"},
        Sample{"dem/a.cpp", "int x = std::rand();\n", "dem/a.cpp: std::rand (use base/rng.h)"}, Sample{"dem/a.cpp", std::string(700, '\n'), ""},
        Sample{"dem/a.cpp", std::string(701, '\n'), "dem/a.cpp: has 701 lines, the limit is 700"},
        Sample{"dem/a.h", std::string(201, '\n'), "dem/a.h: has 201 lines, the limit is 200"}));
}  // namespace venato::structure
