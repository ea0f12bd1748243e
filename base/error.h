#pragma once
#include <stdexcept>
#include <string>
#include <vector>
namespace venato {

/// One mistake in a user's file: where (JSON pointer), what (value, limits with unit, why), what to do about it.
struct ConfigIssue {
  std::string pointer;     ///< e.g. "/chain/3/peak_pressure_mpa"; "" for the whole file
  std::string problem;     ///< e.g. "450 is outside [5, 60] MPa (press rating)"
  std::string suggestion;  ///< e.g. "did you mean 'peak_pressure_mpa'?"; may be empty
};

/// One line: "/press/peak_pressure_mpa: 450 is outside [5, 60] MPa (press rating)". Problems that begin with a verb ("is missing") follow the
/// pointer without a colon; the suggestion comes after "; ".
std::string format_issue(const ConfigIssue& issue);

/// Bad usage or bad input data; the command line prints what() and exits with 2. Nothing has been written.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// All mistakes of one config at once. what() is the printable list, one line per issue.
class ConfigError : public UsageError {
 public:
  ConfigError(std::string file, std::vector<ConfigIssue> issues);
  const std::vector<ConfigIssue>& issues() const { return issues_; }

 private:
  std::vector<ConfigIssue> issues_;
};

/// The work itself failed (disk full, particles blew up, pictures do not belong together …): exit code 1.
class WorkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// SIGINT/SIGTERM arrived and the work stopped at a safe point (checkpoint written): exit code 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace venato
