#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
namespace venato {

enum class Verbosity { quiet, normal };
enum class LogFormat { text, json };

/// Where all messages go. Libraries log at stage borders only (house style 23) and never print themselves.
class Log {
 public:
  virtual ~Log() = default;
  virtual void info(std::string_view message) = 0;
  virtual void warn(std::string_view message) = 0;
};
/// stderr sink (spdlog): plain text or one JSON object per line; quiet keeps warnings.
std::unique_ptr<Log> make_stderr_log(LogFormat format, Verbosity verbosity);
std::unique_ptr<Log> make_null_log();

/// Progress of one long phase at a time: on a terminal a bar with fraction, rate and time left; otherwise a plain line at
/// start, about every 10 s and at the end; as JSON lines with --json-log; nothing when quiet. Thread-compatible (call from one thread).
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void begin(std::string_view phase, double total, std::string_view unit) = 0;
  virtual void at(double done, std::string_view extra = {}) = 0;  ///< cheap: rate limited inside
  virtual void end() = 0;
};
std::unique_ptr<Progress> make_progress(Log& log, LogFormat format, Verbosity verbosity);
std::unique_ptr<Progress> make_null_progress();
}  // namespace venato
