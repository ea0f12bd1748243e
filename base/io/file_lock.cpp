#include "base/io/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "base/error.h"

namespace venato {
namespace {
constexpr auto kLookAgain = std::chrono::milliseconds(200);

/// The holder before may have removed the file while this process waited: then the lock is on a file that has no name any more.
bool still_named(int fd, const std::filesystem::path& file) {
  struct stat of_fd {
  }, of_name{};
  return ::fstat(fd, &of_fd) == 0 && ::stat(file.c_str(), &of_name) == 0 && of_fd.st_ino == of_name.st_ino && of_fd.st_dev == of_name.st_dev;
}
}  // namespace

std::optional<FileLock> FileLock::try_take(const std::filesystem::path& file) {
  while (true) {
    const int fd = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (fd < 0) throw WorkError(file.string() + ": cannot open: " + std::strerror(errno));
    int taken = 0;
    while ((taken = ::flock(fd, LOCK_EX | LOCK_NB)) != 0 && errno == EINTR) {
    }
    if (taken != 0 && errno == EWOULDBLOCK) {
      ::close(fd);
      return std::nullopt;
    }
    if (taken != 0 || still_named(fd, file)) return FileLock(file, fd);
    ::close(fd);
  }
}

FileLock FileLock::take(const std::filesystem::path& file, const std::function<void()>& waiting) {
  while (true) {
    if (auto lock = try_take(file)) return std::move(*lock);
    if (waiting) waiting();
    std::this_thread::sleep_for(kLookAgain);
  }
}

FileLock::~FileLock() {
  if (fd_ < 0) return;
  ::unlink(file_.c_str());  // while still held: nobody can take a lock on it in between that still_named() would accept
  ::close(fd_);
}
FileLock::FileLock(FileLock&& other) noexcept : file_(std::move(other.file_)), fd_(std::exchange(other.fd_, -1)) {}
}  // namespace venato
