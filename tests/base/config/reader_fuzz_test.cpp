#include <gtest/gtest.h>

#include "base/config/object_reader.h"
#include "base/rng.h"

// Damaged files of every sort end in issues with a text, never in a crash, an exception or a silent acceptance of another meaning.
namespace venato {
namespace {
constexpr std::string_view kGood =
    R"({"seed":7,"press":{"peak_pressure_mpa":40.5,"dwell_s":1e-1},"edge_mm":[[0,0],[1,2.5]],"name":"a_b","chain":[{"stage":"belt","length_m":3},{"stage":"press"}]})";

struct Values {
  std::uint64_t seed = 0;
  double pressure_pa = 20e6, dwell_s = 1, length_m = 1;
  std::vector<double> edge_m;
  std::string name;
};

void read_all(ObjectReader& r, Values& v) {
  r.seed("seed", v.seed);
  r.object("press", "", [&](ObjectReader& p) {
    p.number("peak_pressure_mpa", v.pressure_pa, {5, 60, "MPa"});
    p.number("dwell_s", v.dwell_s, {0, 10, "s"});
  });
  r.tuples("edge_mm", v.edge_m, 2, {-10, 10, "mm"}, 1, 5);
  r.name("name", v.name);
  r.objects("chain", "", 0, 5, [&](ObjectReader& s, std::size_t) {
    s.pick("stage", "", {{"press", "", [](ObjectReader&) {}}, {"belt", "", [&](ObjectReader& b) {
                                                                 b.number("length_m", v.length_m, {0, 20, "m"});
                                                               }}});
  });
}

std::string damaged(Rng& rng) {
  static constexpr std::string_view kPieces[] = {"\"",    "{",    "}",       "[",    "]",  ",", ":",    "NaN", "-",
                                                 "1e999", "null", "\\u0000", "\xff", "\n", "0", "true", "9"};
  std::string text(kGood);
  for (std::uint64_t n = 1 + rng.below(4); n > 0; --n) {
    const std::size_t at = rng.below(text.size());
    switch (rng.below(4)) {
      case 0:
        text.erase(at, 1 + rng.below(6));
        break;
      case 1:
        text.insert(at, kPieces[rng.below(std::size(kPieces))]);
        break;
      case 2:
        text[at] = static_cast<char>(rng.below(256));
        break;
      default:
        text.resize(at);
        break;
    }
    if (text.empty()) break;
  }
  return text;
}
}  // namespace

TEST(ReaderFuzz, DamagedFilesGiveIssuesOrValuesInsideTheLimits) {
  Rng rng(20, stream_id("test/reader_fuzz"));
  int refused = 0;
  constexpr int kTrials = 20000;
  for (int i = 0; i < kTrials; ++i) {
    const std::string text = damaged(rng);
    Values v;
    const ReadOutcome outcome = read_config_text(text, ".", {}, [&](ObjectReader& r) { read_all(r, v); });
    refused += !outcome.ok();
    for (const ConfigIssue& issue : outcome.issues) ASSERT_FALSE(issue.problem.empty()) << text;
    ASSERT_TRUE(v.pressure_pa >= 5e6 && v.pressure_pa <= 60e6) << text;
    ASSERT_TRUE(v.dwell_s >= 0 && v.dwell_s <= 10) << text;
    ASSERT_TRUE(v.length_m >= 0 && v.length_m <= 20) << text;
    if (outcome.ok()) {
      Values again;
      const ReadOutcome second = read_config_text(outcome.resolved_json, ".", {}, [&](ObjectReader& r) { read_all(r, again); });
      ASSERT_TRUE(second.ok()) << text;
      ASSERT_EQ(second.resolved_json, outcome.resolved_json) << text;
    }
  }
  EXPECT_GT(refused, kTrials / 2);  // the damage is real …
  EXPECT_LT(refused, kTrials);      // … and some of it leaves a valid file (a digit changed)
}
}  // namespace venato
