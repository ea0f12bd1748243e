#pragma once
#include <string>
#include <vector>
namespace venato {
struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
};
/// Multiples of 1, 2 or 5 times a power of ten inside [low, high], about `wanted` of them (never more than twice that).
/// \param low, high finite, low < high
Ticks round_ticks(double low, double high, int wanted);
}  // namespace venato
