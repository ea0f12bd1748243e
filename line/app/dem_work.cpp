#include "line/app/dem_work.h"

#include "base/error.h"
namespace venato::line::app {
namespace fs = std::filesystem;
namespace {
constexpr const char* kKind = "dem-case";

fs::path folder_of(const Store& store, const std::string& key) {
  fs::path folder = store.checkpoint_path(kKind, key);
  folder += ".d";
  return folder;
}

FileLock lock_of(const fs::path& folder, const std::string& case_name) {
  fs::path file = folder;
  file += ".lock";
  auto lock = FileLock::try_take(file);
  if (!lock)
    throw WorkError("case '" + case_name + "' is being run by another process with the same store (" + file.string() +
                    " is locked); wait for it, or give VENATO_STORE another folder");
  return std::move(*lock);
}
}  // namespace

DemWork::DemWork(const Store& store, const std::string& key, const std::string& case_name)
    : folder_(folder_of(store, key)), lock_(lock_of(folder_, case_name)) {
  std::error_code ec;
  fs::create_directories(folder_, ec);
  if (ec) throw WorkError("cannot create the folder " + folder_.string() + ": " + ec.message());
}

DemWork::~DemWork() {
  std::error_code ignored;
  fs::remove(folder_, ignored);  // fails when there is something in it
}

void DemWork::clear() {
  std::error_code ec;
  fs::remove_all(folder_, ec);
  fs::create_directories(folder_, ec);
  if (ec) throw WorkError("cannot clear the folder " + folder_.string() + ": " + ec.message());
}

void DemWork::place(const std::string& name, const fs::path& target) const {
  if (!fs::is_directory(folder_ / name)) return;
  std::error_code ec;
  fs::create_directories(target, ec);
  for (const auto& entry : fs::directory_iterator(folder_ / name)) {
    const fs::path to = target / entry.path().filename();
    fs::create_hard_link(entry.path(), to, ec);  // safe: files are replaced by renaming, never written into
    if (ec) fs::copy_file(entry.path(), to, fs::copy_options::overwrite_existing, ec);
    if (ec) throw WorkError(to.string() + ": cannot be written: " + ec.message());
  }
}
}  // namespace venato::line::app
