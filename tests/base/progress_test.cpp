#include "base/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/expects.h"
#include "base/hardware.h"
#include "base/progress_text.h"
#include "base/version.h"

namespace venato {
namespace {
struct ListLog final : Log {
  std::vector<std::string> lines;
  void info(std::string_view m) override { lines.emplace_back(m); }
  void warn(std::string_view m) override { lines.push_back("warning: " + std::string(m)); }
};
std::string captured(const std::function<void()>& work) {
  ::testing::internal::CaptureStderr();
  work();
  return ::testing::internal::GetCapturedStderr();
}
}  // namespace

TEST(ProgressText, Durations) {
  EXPECT_EQ(duration_text(4.04), "4.0 s");
  EXPECT_EQ(duration_text(42.4), "42 s");
  EXPECT_EQ(duration_text(59.6), "1 min 00 s");
  EXPECT_EQ(duration_text(125), "2 min 05 s");
  EXPECT_EQ(duration_text(3 * 3600 + 12 * 60 + 30), "3 h 12 min");
  EXPECT_EQ(duration_text(std::numeric_limits<double>::quiet_NaN()), "?");
  EXPECT_EQ(duration_text(-1), "?");
}

TEST(ProgressText, LineHasFractionRateAndTimeLeft) {
  const ProgressState s{"press", "steps", "12 kPa", 250, 1000, 10, 25};
  EXPECT_EQ(progress_line(s), "press   25 %  10 steps/s  left 1 min 15 s  12 kPa");
  const ProgressState unknown{"press", "steps", "", 250, 0, 0, 25};
  EXPECT_EQ(progress_line(unknown), "press    ? %");
}

TEST(ProgressText, BarFitsTheTerminal) {
  const ProgressState s{"press", "steps", "", 500, 1000, 10, 25};
  for (const int columns : {10, 40, 80, 200}) {
    const std::string bar = progress_bar(s, columns, "14:02");
    EXPECT_LT(static_cast<int>(bar.size()), columns);
  }
  EXPECT_NE(progress_bar(s, 120, "14:02").find("[####################....................]"), std::string::npos);
  EXPECT_NE(progress_bar(s, 120, "14:02").find("(14:02)"), std::string::npos);
}

TEST(ProgressText, JsonEvent) {
  const ProgressState s{"pre\"ss", "steps", "", 500, 1000, 10, 25};
  EXPECT_EQ(
      progress_json(s, "at"),
      R"({"done":500,"elapsed_s":25,"fraction":0.5,"left_s":50,"phase":"pre\"ss","progress":"at","rate_per_s":10,"total":1000,"unit":"steps"})");
}

TEST(Progress, PlainLinesAtStartAndEndOnly) {
  ListLog log;
  const auto progress = make_progress(log, LogFormat::text, Verbosity::normal);
  progress->begin("press", 1e6, "steps");
  for (int i = 0; i < 100000; ++i) progress->at(i);  // far below 10 s: no line
  progress->end();
  ASSERT_EQ(log.lines.size(), 2u);
  EXPECT_EQ(log.lines[0], "press  started");
  EXPECT_EQ(log.lines[1].rfind("press  done in ", 0), 0u);
}

TEST(Progress, QuietSaysNothing) {
  ListLog log;
  const auto progress = make_progress(log, LogFormat::text, Verbosity::quiet);
  progress->begin("press", 10, "steps");
  progress->end();
  EXPECT_TRUE(log.lines.empty());
}

TEST(Progress, WorkDoneBeforeAResumeDoesNotCountAsSpeed) {
  ListLog log;
  const auto progress = make_progress(log, LogFormat::json, Verbosity::normal);
  progress->begin("dem", 1000, "steps");
  progress->at(900);  // the checkpoint
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  progress->at(906);
  progress->end();
  const std::string& last = log.lines.back();
  const auto at = last.find("\"rate_per_s\":");
  ASSERT_NE(at, std::string::npos) << last;
  // 6 steps in 0.6 s or a little more on a busy machine; 906 / 0.6 s would be 1510.
  const double rate = std::stod(last.substr(at + 13));
  EXPECT_GT(rate, 0.5);
  EXPECT_LT(rate, 10.5);
}

TEST(StderrLog, TextAndQuiet) {
  EXPECT_EQ(captured([] {
              const auto log = make_stderr_log(LogFormat::text, Verbosity::normal);
              log->info("100 % {} done");
              log->warn("careful");
            }),
            "100 % {} done\nwarning: careful\n");
  EXPECT_EQ(captured([] {
              const auto log = make_stderr_log(LogFormat::text, Verbosity::quiet);
              log->info("hidden");
              log->warn("careful");
            }),
            "warning: careful\n");
}

TEST(StderrLog, JsonLines) {
  const std::string text = captured([] {
    const auto log = make_stderr_log(LogFormat::json, Verbosity::normal);
    log->info("a \"b\"\n");
    const auto progress = make_progress(*log, LogFormat::json, Verbosity::normal);
    progress->begin("press", 0, "steps");
    progress->end();
  });
  const std::string first = "{\"level\":\"info\",\"message\":\"a \\\"b\\\"\\n\"}\n";
  EXPECT_EQ(text.substr(0, first.size()), first);
  EXPECT_NE(text.find("\"phase\":\"press\",\"progress\":\"begin\""), std::string::npos) << text;
  EXPECT_NE(text.find("\"progress\":\"end\""), std::string::npos) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);  // one object per line, nothing else
}

TEST(Version, NamesTheProgramVersion) { EXPECT_EQ(version_string().rfind("0.", 0), 0u) << version_string(); }

TEST(Hardware, FiguresAreSane) {
  EXPECT_GE(available_cores(), 1);
  EXPECT_LE(available_cores(), static_cast<int>(std::thread::hardware_concurrency()));
  EXPECT_FALSE(cpu_model_name().empty());
  EXPECT_GT(peak_memory_bytes(), 1u << 20);
  EXPECT_EQ(cores_of_cpu_max("max 100000"), 0);
  EXPECT_EQ(cores_of_cpu_max("150000 100000"), 2);
  EXPECT_EQ(cores_of_cpu_max("50000 100000"), 1);
  EXPECT_EQ(cores_of_cpu_max(""), 0);
  EXPECT_EQ(cores_of_cpu_max("-1 100000"), 0);
}

TEST(Errors, IssueTexts) {
  EXPECT_EQ(format_issue({"/a", "is missing (no hidden defaults)", ""}), "/a is missing (no hidden defaults)");
  EXPECT_EQ(format_issue({"/a", "450 is outside [5, 60] MPa", ""}), "/a: 450 is outside [5, 60] MPa");
  EXPECT_EQ(format_issue({"", "is nested deeper than 64 levels", ""}), "the file is nested deeper than 64 levels");
  EXPECT_EQ(format_issue({"", "line 2, column 3: no", "fix it"}), "line 2, column 3: no; fix it");
  const ConfigError e("x.json", {{"/a", "is missing", ""}, {"/b", "is missing", ""}});
  EXPECT_STREQ(e.what(), "x.json: 2 mistakes\n  /a is missing\n  /b is missing");
}

TEST(ContractsDeathTest, StayAliveInRelease) {
  EXPECT_DEATH(VENATO_EXPECTS(1 + 1 == 3), "precondition failed: 1 \\+ 1 == 3");
  EXPECT_DEATH(VENATO_ENSURES(false), "postcondition failed: false");
}
}  // namespace venato
