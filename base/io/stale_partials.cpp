#include "base/io/stale_partials.h"

#include <signal.h>

#include <cerrno>
#include <charconv>
#include <string>
#include <vector>
namespace venato {
namespace fs = std::filesystem;
namespace {
bool process_lives(long pid) { return ::kill(static_cast<pid_t>(pid), 0) == 0 || errno == EPERM; }

}  // namespace

void clear_stale_partials(const fs::path& folder, std::string_view prefix) {
  std::error_code ec;
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(folder, ec)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix)) continue;
    long pid = 0;
    const auto digits = std::string_view(name).substr(prefix.size());
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), pid);
    if (parsed.ec == std::errc{} && parsed.ptr == digits.data() + digits.size() && pid > 0 && !process_lives(pid)) stale.push_back(entry.path());
  }
  for (const auto& path : stale) fs::remove_all(path, ec);
}
}  // namespace venato
