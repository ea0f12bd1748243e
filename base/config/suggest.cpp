#include "base/config/suggest.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace venato {
namespace {
// Unit words as they end our keys; a key's unit is its longest tail made of these words.
constexpr std::array<std::string_view, 46> kUnitWords = {"m",        "cm",  "mm",  "um",   "nm", "m2", "mm2", "m3",  "mm3", "s",   "ms",  "us",
                                                         "min",      "h",   "hz",  "khz",  "kg", "g",  "mg",  "t",   "pa",  "kpa", "mpa", "gpa",
                                                         "bar",      "deg", "rad", "rpm",  "n",  "mn", "kn",  "j",   "s2",  "cm3", "pct", "percent",
                                                         "fraction", "dpi", "px",  "inch", "in", "l",  "ppm", "per", "cm2", "mj"};

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::replace(out.begin(), out.end(), '-', '_');
  return out;
}

std::string without_unit(const std::string& key) {
  std::string stem = key;
  for (;;) {
    const auto underscore = stem.rfind('_');
    if (underscore == std::string::npos || underscore == 0) return stem;
    const std::string_view tail = std::string_view(stem).substr(underscore + 1);
    if (std::find(kUnitWords.begin(), kUnitWords.end(), tail) == kUnitWords.end()) return stem;
    stem.resize(underscore);
  }
}
}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  // Optimal string alignment: three rolling rows.
  const std::size_t n = b.size();
  std::vector<int> before(n + 1), last(n + 1), row(n + 1);
  for (std::size_t j = 0; j <= n; ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= n; ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[n];
}

std::string nearest(std::string_view given_as_typed, const std::vector<std::string>& candidates) {
  const std::string given = lower(given_as_typed.substr(0, 200));
  const std::string stem = without_unit(given);
  for (const std::string& c : candidates)
    if (without_unit(lower(c)) == stem) return c;
  std::string best;
  int best_distance = std::max<int>(2, static_cast<int>(given.size() / 3)) + 1;
  if (given.size() <= 3) best_distance = 2;  // of "kg" and "mu" nearly everything would be near
  for (const std::string& c : candidates) {
    const std::string candidate = lower(c);
    const int distance = std::min(edit_distance(given, candidate), edit_distance(stem, without_unit(candidate)));
    if (distance < best_distance) {
      best_distance = distance;
      best = c;
    }
  }
  return best;
}
}  // namespace venato
