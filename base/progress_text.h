#pragma once
#include <string>
#include <string_view>
namespace venato {
/// "4 s", "2 min 05 s", "3 h 12 min"; "?" for unknown (not finite or negative). \param seconds [s]
std::string duration_text(double seconds);
/// "1.2e+06 steps/s", "34 steps/s". \param rate [unit/s]
std::string rate_text(double rate, std::string_view unit);

struct ProgressState {
  std::string_view phase, unit, extra;
  double done = 0, total = 0;  ///< [unit]; total <= 0: unknown
  double rate = 0;             ///< [unit/s], 0 = not known yet
  double elapsed_s = 0;
};
double fraction_of(const ProgressState& state);  ///< in [0, 1]; 0 when the total is unknown
double left_s(const ProgressState& state);       ///< NaN when unknown
/// "press    42 %  1.2e+06 steps/s  left 1 min 12 s  extra": the plain line.
std::string progress_line(const ProgressState& state);
/// The same with a bar, cut to the terminal's width. \param ends_at clock time of the end, may be empty
std::string progress_bar(const ProgressState& state, int columns, std::string_view ends_at);
/// One JSON object without line end.
std::string progress_json(const ProgressState& state, std::string_view event);
}  // namespace venato
