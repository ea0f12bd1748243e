#include "base/error.h"

#include <array>
#include <string_view>
#include <utility>

namespace venato {
namespace {
/// "… is missing", "… must be a number" read on from the pointer; "450 is outside …" stands on its own and needs a colon.
bool continues_the_sentence(std::string_view problem) {
  constexpr std::array<std::string_view, 9> kVerbs = {"is ", "are ", "must ", "has ", "have ", "needs ", "cannot ", "gives ", "'"};
  for (std::string_view verb : kVerbs)
    if (problem.starts_with(verb)) return true;
  return false;
}

std::string list_of(const std::string& file, const std::vector<ConfigIssue>& issues) {
  std::string text = file + ": " + std::to_string(issues.size()) + (issues.size() == 1 ? " mistake" : " mistakes");
  for (const ConfigIssue& issue : issues) text += "\n  " + format_issue(issue);
  return text;
}
}  // namespace

std::string format_issue(const ConfigIssue& issue) {
  const bool joined = continues_the_sentence(issue.problem);
  std::string text = issue.pointer;
  if (issue.pointer.empty() && joined) text = "the file";
  if (!text.empty()) text += joined ? " " : ": ";
  text += issue.problem;
  if (!issue.suggestion.empty()) text += "; " + issue.suggestion;
  return text;
}

ConfigError::ConfigError(std::string file, std::vector<ConfigIssue> issues) : UsageError(list_of(file, issues)), issues_(std::move(issues)) {}

}  // namespace venato
