#include "base/progress_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/config/json_value.h"

namespace venato {
namespace {
template <class... Args>
std::string printed(const char* format, Args... args) {
  char text[64];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}
std::string percent(const ProgressState& s) { return s.total > 0 ? printed("%3.0f %%", std::floor(100 * fraction_of(s))) : "  ? %"; }

std::string tail(const ProgressState& s) {
  std::string text;
  if (s.rate > 0) text += std::string("  ") + rate_text(s.rate, s.unit);
  if (std::isfinite(left_s(s))) text += std::string("  left ") + duration_text(left_s(s));
  if (!s.extra.empty()) text.append("  ").append(s.extra);
  return text;
}
}  // namespace

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0) return "?";
  if (seconds < 9.95) return printed("%.1f s", seconds);
  const double whole = std::round(seconds);
  if (whole < 60) return printed("%.0f s", whole);
  if (whole < 3600) return printed("%.0f min %02.0f s", std::floor(whole / 60), std::fmod(whole, 60));
  return printed("%.0f h %02.0f min", std::floor(whole / 3600), std::floor(std::fmod(whole, 3600) / 60));
}

std::string rate_text(double rate, std::string_view unit) { return printed(rate >= 1e5 ? "%.2e " : "%.3g ", rate) + std::string(unit) + "/s"; }

double fraction_of(const ProgressState& s) { return s.total > 0 ? std::clamp(s.done / s.total, 0.0, 1.0) : 0.0; }

double left_s(const ProgressState& s) {
  if (!(s.total > 0) || !(s.rate > 0)) return std::numeric_limits<double>::quiet_NaN();
  return std::max(0.0, s.total - s.done) / s.rate;
}

std::string progress_line(const ProgressState& s) { return std::string(s.phase) + "  " + percent(s) + tail(s); }

std::string progress_bar(const ProgressState& s, int columns, std::string_view ends_at) {
  std::string right = std::string(" ") + percent(s) + tail(s);
  if (!ends_at.empty()) right += "  (" + std::string(ends_at) + ")";
  const int room = columns - 1 - static_cast<int>(s.phase.size() + right.size()) - 4;
  const int cells = std::clamp(room, 0, 40);
  std::string line(s.phase);
  if (cells >= 6) {
    const int full = static_cast<int>(std::floor(cells * fraction_of(s)));
    line += " [";
    line.append(static_cast<std::size_t>(full), '#').append(static_cast<std::size_t>(cells - full), '.') += "]";
  }
  line += right;
  if (static_cast<int>(line.size()) >= columns) line.resize(static_cast<std::size_t>(std::max(0, columns - 1)));
  return line;
}

std::string progress_json(const ProgressState& s, std::string_view event) {
  JsonValue::Object o{{"progress", event}, {"phase", s.phase}, {"done", s.done}, {"unit", s.unit}, {"elapsed_s", s.elapsed_s}};
  if (s.total > 0) {
    o.emplace("total", s.total);
    o.emplace("fraction", fraction_of(s));
  }
  if (s.rate > 0) o.emplace("rate_per_s", s.rate);
  if (std::isfinite(left_s(s))) o.emplace("left_s", left_s(s));
  if (!s.extra.empty()) o.emplace("extra", s.extra);
  return to_text(JsonValue(std::move(o)));
}
}  // namespace venato
