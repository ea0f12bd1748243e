#include <algorithm>

#include "line/commands/plan_head.h"
namespace venato::line {
namespace {

struct Run {
  int start, length;
};
/// Maximal cyclic runs of `value`, in order of their start; empty when the column has only one value.
std::vector<Run> runs_of(const std::vector<double>& column, double value) {
  std::vector<Run> runs;
  const int n = static_cast<int>(column.size());
  const auto at = [&](int i) { return column[static_cast<std::size_t>(((i % n) + n) % n)]; };
  for (int i = 0; i < n; ++i) {
    if (at(i) != value || at(i - 1) == value) continue;
    int length = 1;
    while (length < n && at(i + length) == value) ++length;
    runs.push_back({i, length});
  }
  return runs;
}
void set(std::vector<double>& column, int start, int length, double value) {
  const int n = static_cast<int>(column.size());
  for (int i = start; i < start + length; ++i) column[static_cast<std::size_t>(((i % n) + n) % n)] = value;
}
void close_gaps(std::vector<double>& column, int min_off) {
  for (const auto& gap : runs_of(column, 0.0))
    if (gap.length < min_off) set(column, gap.start, gap.length, 1.0);
}
}  // namespace

void enforce_min_times(std::vector<double>& column, int min_on, int min_off) {
  if (column.empty()) return;
  const int n = static_cast<int>(column.size());
  close_gaps(column, min_off);
  for (const auto& pulse : runs_of(column, 1.0)) {
    if (pulse.length >= min_on) continue;
    const int more = std::min(min_on, n) - pulse.length;
    set(column, pulse.start - more / 2, pulse.length + more, 1.0);
  }
  close_gaps(column, min_off);  // longer pulses may have left gaps that are too short now
}
}  // namespace venato::line
