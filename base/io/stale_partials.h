#pragma once
#include <filesystem>
#include <string_view>
namespace venato {
/// Removes the entries "<prefix><pid>" of `folder` whose process no longer runs: what a killed program of ours left there. Anything else stays.
/// Errors are ignored: leftovers are harmless.
void clear_stale_partials(const std::filesystem::path& folder, std::string_view prefix);
}  // namespace venato
