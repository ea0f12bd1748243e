#include "base/rng.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

namespace venato {
using Block = std::array<std::uint32_t, 4>;

// Known answers of Random123 1.14 (kat_vectors, philox4x32 10).
TEST(Philox, KnownAnswers) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t f = 0xffffffffu;
  EXPECT_EQ(philox4x32({f, f, f, f}, {f, f}), (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Rng, DependsOnEveryPartOfItsName) {
  std::set<std::uint32_t> first;
  for (const auto& [seed, stream, entity, step] : std::vector<std::array<std::uint64_t, 4>>{{1, 2, 3, 4},
                                                                                            {2, 2, 3, 4},
                                                                                            {1, 3, 3, 4},
                                                                                            {1, 2, 4, 4},
                                                                                            {1, 2, 3, 5},
                                                                                            {2, 1, 3, 4},
                                                                                            {1, 2, 4, 3},
                                                                                            {1ull << 32, 2, 3, 4},
                                                                                            {1, 2, 3ull << 32, 4}})
    first.insert(Rng(seed, stream, entity, step).bits());
  EXPECT_EQ(first.size(), 9u);
  EXPECT_EQ(Rng(1, 2, 3, 4).bits(), Rng(1, 2, 3, 4).bits());
}

// n = 2e5: the standard error of the mean is 6.5e-4, of the variance 1.7e-4; limits at 5 standard errors. The seed is fixed, so it cannot flake.
TEST(Rng, UniformMomentsAndRange) {
  Rng rng(7, stream_id("test/uniform"));
  constexpr int n = 200000;
  double sum = 0, squares = 0, low = 1, high = 0;
  for (int i = 0; i < n; ++i) {
    const double u = rng.uniform();
    sum += u;
    squares += u * u;
    low = std::min(low, u);
    high = std::max(high, u);
  }
  EXPECT_GE(low, 0);
  EXPECT_LT(high, 1);
  EXPECT_NEAR(sum / n, 0.5, 5 * 6.5e-4);
  EXPECT_NEAR(squares / n - (sum / n) * (sum / n), 1.0 / 12, 5 * 1.7e-4);
}

// Chi-square over 64 cells, 63 degrees of freedom: mean 63, standard deviation 11.2; 5 sigma both ways (too even is a fault as well).
TEST(Rng, UniformCellsChiSquare) {
  constexpr int cells = 64, n = 128000;
  std::vector<double> count(cells);
  for (int i = 0; i < n; ++i) count[static_cast<std::size_t>(Rng(11, stream_id("test/cells"), static_cast<std::uint64_t>(i)).uniform() * cells)] += 1;
  double chi2 = 0;
  const double expected = static_cast<double>(n) / cells;
  for (const double c : count) chi2 += (c - expected) * (c - expected) / expected;
  EXPECT_NEAR(chi2, 63, 5 * 11.2);
}

// Standard errors at n = 2e5: mean 2.2e-3, variance 3.2e-3, skewness 5.5e-3, kurtosis 1.1e-2; limits at 5 of them.
TEST(Rng, NormalMoments) {
  Rng rng(3, stream_id("test/normal"));
  constexpr int n = 200000;
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0, neighbours = 0, last = 0;
  for (int i = 0; i < n; ++i) {
    const double x = rng.normal();
    m1 += x / n;
    m2 += x * x / n;
    m3 += x * x * x / n;
    m4 += x * x * x * x / n;
    neighbours += x * last / n;
    last = x;
  }
  EXPECT_NEAR(m1, 0, 5 * 2.2e-3);
  EXPECT_NEAR(m2, 1, 5 * 3.2e-3);
  EXPECT_NEAR(m3, 0, 5 * 8.7e-3);          // raw third moment: sqrt(15 / n)
  EXPECT_NEAR(m4, 3, 5 * 2.2e-2);          // raw fourth moment: sqrt(96 / n)
  EXPECT_NEAR(neighbours, 0, 5 * 2.2e-3);  // both values of a Box-Muller pair are independent
}

// 3 cells, n = 9e4: standard deviation of a count is 141.
TEST(Rng, BelowIsFairAndInRange) {
  Rng rng(5, stream_id("test/below"));
  std::array<int, 3> count{};
  for (int i = 0; i < 90000; ++i) ++count.at(rng.below(3));
  for (const int c : count) EXPECT_NEAR(c, 30000, 5 * 141);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(rng.below(1), 0u);
  const std::uint64_t huge = (1ull << 63) + 1;
  for (int i = 0; i < 100; ++i) EXPECT_LT(rng.below(huge), huge);
}

// Streams are told apart by a 64-bit hash of their path only: every literal of the sources must give another id, and mean one place.
std::map<std::string, std::set<std::string>> stream_literals(const std::filesystem::path& root) {
  std::map<std::string, std::set<std::string>> files_of;
  const std::regex literal("stream_id\\(\"([^\"]*)\"\\)");
  for (const char* module : {"base", "dem", "graphics", "sync", "line"}) {
    if (!std::filesystem::exists(root / module)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / module)) {
      if (!entry.is_regular_file() || (entry.path().extension() != ".cpp" && entry.path().extension() != ".h")) continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        if (line.find("///") != std::string::npos) continue;  // rng.h shows one in its documentation
        for (std::sregex_iterator it(line.begin(), line.end(), literal), end; it != end; ++it) files_of[(*it)[1]].insert(entry.path().string());
      }
    }
  }
  return files_of;
}

void expect_distinct(const std::map<std::string, std::set<std::string>>& files_of, std::vector<std::string>& problems) {
  std::map<std::uint64_t, std::string> path_of;
  for (const auto& [path, files] : files_of) {
    if (files.size() > 1) problems.push_back("stream \"" + path + "\" is used in " + std::to_string(files.size()) + " files, e.g. " + *files.begin());
    const auto [it, fresh] = path_of.emplace(stream_id(path), path);
    if (!fresh) problems.push_back("streams \"" + path + "\" and \"" + it->second + "\" have the same id");
  }
}

TEST(StreamIds, AreUniqueInTheTree) {
  std::vector<std::string> problems;
  expect_distinct(stream_literals(VENATO_SOURCE_DIR), problems);
  for (const std::string& p : problems) ADD_FAILURE() << p;
}

TEST(StreamIds, TheScanFindsLiteralsAndSharedStreams) {
  const auto root = std::filesystem::temp_directory_path() / ("venato_streams_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()));
  std::filesystem::create_directories(root / "dem");
  for (const char* name : {"a.cpp", "b.cpp"}) std::ofstream(root / "dem" / name) << "auto r = Rng(s, stream_id(\"dem/one\"), 0);\n";
  std::vector<std::string> problems;
  const auto found = stream_literals(root);
  expect_distinct(found, problems);
  std::filesystem::remove_all(root);
  EXPECT_EQ(found.size(), 1u);
  EXPECT_EQ(problems.size(), 1u);
}
}  // namespace venato
