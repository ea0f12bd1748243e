/// rank_usage FILE COMMAND...: runs the command, then appends one line to FILE: peak resident memory [KiB], user and system CPU time [s]. For the ranks of
/// mpirun, whose own output sums up nothing. Exits as the command did.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

namespace {
double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }
}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: rank_usage FILE COMMAND...\n");
    return 2;
  }
  const pid_t child = ::fork();
  if (child == 0) {
    ::execvp(argv[2], argv + 2);
    std::perror(argv[2]);
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  if (child < 0 || ::wait4(child, &status, 0, &usage) != child) {
    std::perror("rank_usage");
    return 1;
  }
  char line[128];
  const int length = std::snprintf(line, sizeof line, "%ld %.3f %.3f\n", usage.ru_maxrss, seconds(usage.ru_utime), seconds(usage.ru_stime));
  const int file = ::open(argv[1], O_WRONLY | O_CREAT | O_APPEND, 0644);  // one write: lines of several ranks do not mix
  if (file < 0 || ::write(file, line, static_cast<std::size_t>(length)) != length) {
    std::perror(argv[1]);
    return 1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
