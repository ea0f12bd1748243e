#include "base/io/atomic_file.h"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "base/error.h"

namespace venato {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, std::string_view what, int error) {
  throw WorkError(path.string() + ": " + std::string(what) + ": " + std::strerror(error));
}

void sync_path(const fs::path& path, int flags) {
  const int fd = ::open(path.c_str(), flags | O_CLOEXEC);
  if (fd < 0) fail(path, "cannot open to flush", errno);
  const int rc = ::fsync(fd);
  const int error = errno;
  ::close(fd);
  // Some file systems (FUSE, some network mounts) cannot fsync a folder and say EINVAL: nothing better can be done there.
  if (rc != 0 && error != EINVAL && error != ENOTSUP) fail(path, "cannot flush to disk", error);
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

std::string in_gib(std::uintmax_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GiB", static_cast<double>(bytes) / 1073741824.0);
  return text;
}
}  // namespace

fs::path partial_path(const fs::path& final_path) {
  fs::path partial = final_path;
  partial += ".partial-" + std::to_string(::getpid());
  return partial;
}

void commit_partial(const fs::path& partial, const fs::path& final_path) {
  sync_path(partial, O_RDONLY);
  if (::rename(partial.c_str(), final_path.c_str()) != 0) fail(final_path, "cannot rename the finished file", errno);
  sync_path(folder_of(final_path), O_RDONLY | O_DIRECTORY);
}

void write_atomically(const fs::path& final_path, const std::function<void(const fs::path&)>& write) {
  const fs::path partial = partial_path(final_path);
  try {
    write(partial);
    commit_partial(partial, final_path);
  } catch (...) {
    std::error_code ignored;  // the first error is the one to report
    fs::remove(partial, ignored);
    throw;
  }
}

void write_text_atomically(const fs::path& final_path, std::string_view text) {
  write_atomically(final_path, [&](const fs::path& partial) {
    std::FILE* file = std::fopen(partial.c_str(), "wb");
    if (!file) fail(final_path, "cannot write", errno);
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const int error = errno;
    if (std::fclose(file) != 0) fail(final_path, "cannot write", errno);
    if (!written) fail(final_path, "cannot write", error);
  });
}

std::string read_file(const fs::path& path, std::uintmax_t limit_bytes) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) throw UsageError(path.string() + ": no such file");
  if (fs::is_directory(status)) throw UsageError(path.string() + ": is a folder, not a file");
  if (!fs::is_regular_file(status)) throw UsageError(path.string() + ": is not a regular file");
  const auto size = fs::file_size(path, error);
  if (error) throw UsageError(path.string() + ": cannot read: " + error.message());
  if (size > limit_bytes)
    throw UsageError(path.string() + ": has " + std::to_string(size) + " bytes, the limit is " + std::to_string(limit_bytes) + " bytes");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw UsageError(path.string() + ": cannot read: " + std::strerror(errno));
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (file.bad() || file.gcount() != static_cast<std::streamsize>(size)) throw UsageError(path.string() + ": cannot read all of it");
  return bytes;
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw UsageError(folder.string() + ": cannot create the folder: " + (error ? error.message() : std::string("a file of this name exists")));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) throw UsageError(folder.string() + ": cannot write into the folder: " + std::strerror(errno));
}

void require_free_space(const fs::path& folder, std::uintmax_t bytes, std::string_view what_for) {
  struct statvfs info {};
  if (::statvfs(folder.c_str(), &info) != 0) fail(folder, "cannot ask for free space", errno);
  const std::uintmax_t free_bytes = static_cast<std::uintmax_t>(info.f_bavail) * info.f_frsize;
  if (free_bytes < bytes)
    throw WorkError(std::string(what_for) + " needs " + in_gib(bytes) + ", " + in_gib(free_bytes) + " free on " + folder.string());
}
}  // namespace venato
