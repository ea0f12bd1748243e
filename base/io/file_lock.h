#pragma once
#include <filesystem>
#include <functional>
#include <optional>
namespace venato {

/// Exclusive lock of one process (or one holder inside a process) on a lock file; the operating system lets go when the process ends, however it
/// ends. The file is made when missing and removed on release. File systems without locks: everybody gets the lock (as without this class).
class FileLock {
 public:
  /// Empty when somebody else holds it. \throws WorkError when the file cannot be made.
  static std::optional<FileLock> try_take(const std::filesystem::path& file);
  /// Waits for it. `waiting` (may be null) is called about every 0.2 s while somebody else holds it; what it throws ends the wait.
  static FileLock take(const std::filesystem::path& file, const std::function<void()>& waiting = nullptr);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) = delete;

 private:
  FileLock(std::filesystem::path file, int fd) : file_(std::move(file)), fd_(fd) {}
  std::filesystem::path file_;
  int fd_;
};
}  // namespace venato
