#include "sync/mask/staged_folder.h"

#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "base/error.h"
#include "base/io/atomic_file.h"
#include "base/io/stale_partials.h"

namespace venato::sync {
namespace fs = std::filesystem;
namespace {
constexpr const char* kPrefix = ".partial-";
}

StagedFolder::StagedFolder(fs::path final_folder) : final_(std::move(final_folder)) {
  make_output_folder(final_);
  clear_stale_partials(final_, kPrefix);
  staging_ = final_ / (kPrefix + std::to_string(::getpid()));
  std::error_code error;
  fs::remove_all(staging_, error);
  fs::create_directory(staging_, error);
  if (error) throw UsageError(final_.string() + ": cannot be written to: " + error.message());
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;  // a destructor cannot report; the hidden folder is harmless
  fs::remove_all(staging_, ignored);
}

void StagedFolder::publish(const std::string& last) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(staging_))
    if (entry.path().filename() != last) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  if (fs::exists(staging_ / last)) names.push_back(last);

  std::vector<std::string> moved;
  std::error_code error;
  fs::remove(final_ / last, error);
  for (const std::string& name : names) {
    if (!error) fs::rename(staging_ / name, final_ / name, error);
    if (error) {
      for (const std::string& done : moved) {
        std::error_code ignored;
        fs::remove(final_ / done, ignored);
      }
      throw WorkError((final_ / name).string() + ": cannot be written: " + error.message());
    }
    moved.push_back(name);
  }
}

}  // namespace venato::sync
