#include "base/store/store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "base/config/json_parse.h"
#include "base/error.h"
#include "base/expects.h"
#include "base/io/atomic_file.h"

namespace venato {
namespace fs = std::filesystem;
namespace {

/// Held while an entry's two files change names, so that another process never pairs one's data with the other's manifest.
/// Without write permission (a store shared read-only) there is nothing to hold: this process changes no names.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder) : fd_(::open((folder / ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
    if (fd_ < 0 && errno != EACCES && errno != EROFS) throw WorkError((folder / ".lock").string() + ": cannot open: " + std::strerror(errno));
    while (fd_ >= 0 && ::flock(fd_, LOCK_EX) != 0)
      if (errno != EINTR) break;  // file systems without locks: renames are still atomic one by one
  }
  ~FolderLock() {
    if (fd_ >= 0) ::close(fd_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_;
};

struct EntryPaths {
  fs::path folder, data, manifest;
};

EntryPaths paths_of(const fs::path& root, std::string_view kind, const std::string& key) {
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  VENATO_EXPECTS(!kind.empty() && std::all_of(kind.begin(), kind.end(), plain));
  VENATO_EXPECTS(key.size() >= 8 && std::all_of(key.begin(), key.end(), plain));
  const fs::path folder = root / kind / key.substr(0, 2);
  return {folder, folder / (key + ".h5"), folder / (key + ".json")};
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) throw WorkError(folder.string() + ": cannot create the folder: " + error.message());
}

std::string manifest_text(std::string_view kind, const std::string& key, std::string_view code_version, const fs::path& data) {
  JsonValue::Object m{{"kind", kind}, {"key", key}, {"code_version", code_version}, {"sha256", sha256_of_file(data)}};
  m.emplace("size_bytes", static_cast<std::uint64_t>(fs::file_size(data)));
  return to_text(JsonValue(std::move(m)), 2) + "\n";
}

bool matches_manifest(const EntryPaths& entry) {
  constexpr std::uintmax_t kManifestLimit = 1u << 20;
  try {
    const JsonParse parsed = parse_json(read_file(entry.manifest, kManifestLimit));
    if (!parsed.usable) return false;
    const JsonValue* size = find_pointer(parsed.value, "/size_bytes");
    const JsonValue* sha = find_pointer(parsed.value, "/sha256");
    if (!size || !size->is_number() || !sha || !sha->text()) return false;
    if (size->as_double() != static_cast<double>(fs::file_size(entry.data))) return false;
    return *sha->text() == sha256_of_file(entry.data);
  } catch (const std::exception&) {
    return false;  // unreadable counts as damaged
  }
}

void set_aside(const fs::path& path) {
  fs::path aside = path;
  aside += ".corrupt";
  std::error_code error;
  fs::rename(path, aside, error);
  if (error) fs::remove(path, error);
}
}  // namespace

std::string store_key(std::string_view kind, std::string_view canonical_inputs, const std::vector<std::string>& parents,
                      std::string_view code_version) {
  std::string recipe;
  // Each field goes in behind its length: ("ab", "c") and ("a", "bc") must differ.
  const auto field = [&](std::string_view text) {
    recipe += std::to_string(text.size()) + ":";
    recipe += text;
  };
  field("venato-store-1");
  field(kind);
  field(canonical_inputs);
  field(std::to_string(parents.size()));
  for (const std::string& parent : parents) field(parent);
  field(code_version);
  return sha256_hex(recipe);
}

Store::Store(fs::path root) : root_(std::move(root)) { make_output_folder(root_); }

fs::path Store::default_root() {
  const auto variable = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);
    return value ? value : "";
  };
  if (const fs::path own = variable("VENATO_STORE"); !own.empty()) return own;
  if (const fs::path cache = variable("XDG_CACHE_HOME"); !cache.empty()) return cache / "venato";
  if (const fs::path home = variable("HOME"); !home.empty()) return home / ".cache" / "venato";
  throw UsageError("no place for the operator store: set VENATO_STORE to a folder (HOME is not set)");
}

std::optional<fs::path> Store::find(std::string_view kind, const std::string& key) const {
  const EntryPaths entry = paths_of(root_, kind, key);
  std::error_code error;
  if (!fs::exists(entry.data, error) && !fs::exists(entry.manifest, error)) return std::nullopt;
  const FolderLock lock(entry.folder);
  const bool has_data = fs::exists(entry.data, error), has_manifest = fs::exists(entry.manifest, error);
  if (has_data && has_manifest && matches_manifest(entry)) return entry.data;
  // Data without manifest: its writer was killed between the two renames. Nothing vouches for it, so it goes the same way.
  if (has_data) set_aside(entry.data);
  if (has_manifest) set_aside(entry.manifest);
  return std::nullopt;
}

fs::path Store::put(std::string_view kind, const std::string& key, std::string_view code_version, const std::function<void(const fs::path&)>& write) {
  const EntryPaths entry = paths_of(root_, kind, key);
  make_folder(entry.folder);
  fs::path draft = entry.data;
  draft += ".partial-" + std::to_string(::getpid()) + "-put";  // not partial_path(): H5Writer uses that name itself on the way to `draft`
  try {
    write(draft);
    const std::string manifest = manifest_text(kind, key, code_version, draft);
    const FolderLock lock(entry.folder);
    std::error_code ignored;
    fs::remove(entry.manifest, ignored);  // from here until the new manifest stands, the entry counts as missing
    commit_partial(draft, entry.data);
    write_text_atomically(entry.manifest, manifest);
  } catch (...) {
    std::error_code ignored;
    fs::remove(draft, ignored);
    throw;
  }
  return entry.data;
}

fs::path Store::checkpoint_path(std::string_view kind, const std::string& key) const {
  const EntryPaths entry = paths_of(root_, kind, key);
  make_folder(entry.folder);
  return entry.folder / (key + ".checkpoint.h5");
}

void Store::drop_checkpoint(std::string_view kind, const std::string& key) const {
  std::error_code ignored;
  fs::remove(paths_of(root_, kind, key).folder / (key + ".checkpoint.h5"), ignored);
}
}  // namespace venato
