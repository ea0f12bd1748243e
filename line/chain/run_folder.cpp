#include "line/chain/run_folder.h"

#include <unistd.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/io/stale_partials.h"
namespace venato::line {
namespace fs = std::filesystem;
namespace {
constexpr std::string_view kPrefix = ".venato-partial-";

}  // namespace

RunFolder::RunFolder(fs::path out) : out_(std::move(out)), staging_(out_ / (std::string(kPrefix) + std::to_string(::getpid()))) {
  std::error_code ec;
  created_ = !fs::exists(out_, ec);
  make_output_folder(out_);
  clear_stale_partials(out_, kPrefix);
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
