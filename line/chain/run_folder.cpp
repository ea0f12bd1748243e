#include "line/chain/run_folder.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/io/atomic_file.h"
namespace venato::line {
namespace fs = std::filesystem;
namespace {
constexpr std::string_view kPrefix = ".venato-partial-";

bool process_lives(long pid) { return ::kill(static_cast<pid_t>(pid), 0) == 0 || errno == EPERM; }

/// Leftovers of processes that no longer run.
void clear_stale(const fs::path& out) {
  std::error_code ec;
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(out, ec)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPrefix)) continue;
    long pid = 0;
    const auto digits = std::string_view(name).substr(kPrefix.size());
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), pid);
    if (parsed.ec == std::errc{} && parsed.ptr == digits.data() + digits.size() && pid > 0 && !process_lives(pid)) stale.push_back(entry.path());
  }
  for (const auto& path : stale) fs::remove_all(path, ec);
}
}  // namespace

RunFolder::RunFolder(fs::path out) : out_(std::move(out)), staging_(out_ / (std::string(kPrefix) + std::to_string(::getpid()))) {
  std::error_code ec;
  created_ = !fs::exists(out_, ec);
  make_output_folder(out_);
  clear_stale(out_);
  fs::create_directory(staging_, ec);
  if (ec) throw UsageError(out_.string() + ": cannot be written to: " + ec.message());
}

RunFolder::~RunFolder() {
  std::error_code ec;
  fs::remove_all(staging_, ec);
  if (created_) fs::remove(out_, ec);  // only succeeds when it is empty
}

void RunFolder::publish() {
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(staging_)) entries.push_back(entry.path());
  for (const auto& path : entries) {
    const fs::path target = out_ / path.filename();
    std::error_code ec;
    if (fs::is_directory(target, ec)) {
      // rename() does not replace a folder that has content: the old one steps aside into the staging folder and goes with it.
      fs::rename(target, staging_ / (path.filename().string() + ".old"), ec);
      if (ec) throw WorkError(target.string() + ": cannot be replaced: " + ec.message());
    }
    fs::rename(path, target, ec);
    if (ec) throw WorkError(target.string() + ": cannot be written: " + ec.message());
  }
  created_ = false;
}
}  // namespace venato::line
