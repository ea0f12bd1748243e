#pragma once
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>
namespace venato::sync {

/// Wall time that one phase of a registration took, over all its passes. Never written to a result file: results are the same bytes every time.
struct Phase {
  std::string name;
  double seconds = 0;
};
/// Adds the time since the last lap to a named phase of `phases`, in the order in which the phases first ended.
class PhaseClock {
 public:
  explicit PhaseClock(std::vector<Phase>& phases) : phases_(phases), last_(now()) {}
  void lap(const char* name) {
    const auto t = now();
    const auto at = std::find_if(phases_.begin(), phases_.end(), [&](const Phase& p) { return p.name == name; });
    const double seconds = std::chrono::duration<double>(t - last_).count();
    if (at == phases_.end())
      phases_.push_back({name, seconds});
    else
      at->seconds += seconds;
    last_ = t;
  }

 private:
  static std::chrono::steady_clock::time_point now() { return std::chrono::steady_clock::now(); }
  std::vector<Phase>& phases_;
  std::chrono::steady_clock::time_point last_;
};
}  // namespace venato::sync
