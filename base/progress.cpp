#include "base/progress.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <ctime>

#include "base/config/json_value.h"
#include "base/progress_text.h"

namespace venato {
namespace {
using Clock = std::chrono::steady_clock;
constexpr double kTerminalPeriod_s = 0.2;
constexpr double kPlainPeriod_s = 10;
constexpr double kJsonPeriod_s = 2;
constexpr double kResumeWindow_s = 0.25;  ///< progress reported this early was done before (a checkpoint), not now

double seconds_between(Clock::time_point a, Clock::time_point b) { return std::chrono::duration<double>(b - a).count(); }

class NullLog final : public Log {
 public:
  void info(std::string_view) override {}
  void warn(std::string_view) override {}
};

class NullProgress final : public Progress {
 public:
  void begin(std::string_view, double, std::string_view) override {}
  void at(double, std::string_view) override {}
  void end() override {}
};

/// All lines and the bar go through here, so that a message never lands in the middle of the bar.
class StderrLog final : public Log {
 public:
  StderrLog(LogFormat format, Verbosity verbosity)
      : logger_("venato", std::make_shared<spdlog::sinks::stderr_sink_mt>()), format_(format), quiet_(verbosity == Verbosity::quiet) {
    logger_.set_pattern("%v");
    logger_.flush_on(spdlog::level::info);
  }
  void info(std::string_view message) override {
    if (!quiet_) line(spdlog::level::info, "info", "", message);
  }
  void warn(std::string_view message) override { line(spdlog::level::warn, "warning", "warning: ", message); }
  void raw(std::string_view text) {
    hide_bar();
    logger_.log(spdlog::level::info, text);
  }
  void show_bar(const std::string& bar) {
    std::fprintf(stderr, "\r\033[K%s", bar.c_str());
    std::fflush(stderr);
    bar_visible_ = true;
  }
  void hide_bar() {
    if (bar_visible_) std::fputs("\r\033[K", stderr);
    bar_visible_ = false;
  }

 private:
  void line(spdlog::level::level_enum level, const char* name, const char* prefix, std::string_view message) {
    hide_bar();
    if (format_ == LogFormat::json)
      logger_.log(level, "{}", to_text(JsonValue(JsonValue::Object{{"level", name}, {"message", message}})));
    else
      logger_.log(level, "{}{}", prefix, message);
  }
  spdlog::logger logger_;
  LogFormat format_;
  bool quiet_;
  bool bar_visible_ = false;
};

int terminal_columns() {
  struct winsize size {};
  constexpr int kUsual = 80;
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

std::string clock_in(double seconds) {
  const std::time_t then = std::time(nullptr) + static_cast<std::time_t>(seconds);
  std::tm local{};
  ::localtime_r(&then, &local);
  char text[16];
  std::strftime(text, sizeof text, "%H:%M", &local);
  return text;
}

class LogProgress final : public Progress {
 public:
  LogProgress(Log& log, LogFormat format)
      : log_(log),
        stderr_log_(dynamic_cast<StderrLog*>(&log)),
        json_(format == LogFormat::json),
        bar_(!json_ && stderr_log_ && ::isatty(STDERR_FILENO)) {}
  void begin(std::string_view phase, double total, std::string_view unit) override {
    phase_ = phase;
    unit_ = unit;
    total_ = total;
    done_ = first_done_ = 0;
    started_ = last_shown_ = Clock::now();
    first_call_ = true;
    show("begin", started_);
  }
  void at(double done, std::string_view extra) override {
    const auto now = Clock::now();
    if (first_call_ && seconds_between(started_, now) < kResumeWindow_s) first_done_ = done;
    first_call_ = false;
    done_ = done;
    if (seconds_between(last_shown_, now) < (bar_ ? kTerminalPeriod_s : json_ ? kJsonPeriod_s : kPlainPeriod_s)) return;
    last_shown_ = now;
    extra_ = extra;
    show("at", now);
  }
  void end() override {
    extra_.clear();
    show("end", Clock::now());
  }

 private:
  void show(std::string_view event, Clock::time_point now) {
    ProgressState s{phase_, unit_, extra_, done_, total_, 0, seconds_between(started_, now)};
    if (s.elapsed_s > 0.5) s.rate = (done_ - first_done_) / s.elapsed_s;
    if (json_) {
      stderr_log_ ? stderr_log_->raw(progress_json(s, event)) : log_.info(progress_json(s, event));
    } else if (event == "end") {
      if (stderr_log_) stderr_log_->hide_bar();
      log_.info(phase_ + "  done in " + duration_text(s.elapsed_s));
    } else if (bar_) {
      const double left = left_s(s);
      stderr_log_->show_bar(progress_bar(s, terminal_columns(), left >= 60 ? clock_in(left) : ""));
    } else {
      log_.info(event == "begin" ? phase_ + "  started" : progress_line(s));
    }
  }
  Log& log_;
  StderrLog* stderr_log_;  ///< nullptr with other logs: no bar then
  bool json_, bar_;
  std::string phase_, unit_, extra_;
  double total_ = 0, done_ = 0, first_done_ = 0;
  bool first_call_ = true;
  Clock::time_point started_, last_shown_;
};
}  // namespace

std::unique_ptr<Log> make_stderr_log(LogFormat format, Verbosity verbosity) { return std::make_unique<StderrLog>(format, verbosity); }
std::unique_ptr<Log> make_null_log() { return std::make_unique<NullLog>(); }
std::unique_ptr<Progress> make_null_progress() { return std::make_unique<NullProgress>(); }
std::unique_ptr<Progress> make_progress(Log& log, LogFormat format, Verbosity verbosity) {
  if (verbosity == Verbosity::quiet) return make_null_progress();
  return std::make_unique<LogProgress>(log, format);
}
}  // namespace venato
