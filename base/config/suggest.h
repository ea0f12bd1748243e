#pragma once
#include <string>
#include <string_view>
#include <vector>
namespace venato {

/// Number of single-character insertions, deletions, replacements and swaps of neighbours from a to b.
int edit_distance(std::string_view a, std::string_view b);

/// The candidate that the user most likely meant, "" when none is near: same words with another unit suffix (belt_speed_mm_s for
/// belt_speed_m_s) or without it, else edit distance <= max(2, a third of the length). Earlier candidates win ties.
std::string nearest(std::string_view given, const std::vector<std::string>& candidates);
}  // namespace venato
