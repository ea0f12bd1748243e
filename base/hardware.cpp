#include "base/hardware.h"

#include <malloc.h>
#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

namespace venato {
namespace {
std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

int quota_cores(double quota_us, double period_us) {
  if (!(quota_us > 0) || !(period_us > 0)) return 0;
  return std::max(1, static_cast<int>(std::ceil(quota_us / period_us)));
}

int cgroup_cores() {
  // The process' own group of cgroup v2, then the root that a container sees, then v1.
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);)
    if (line.starts_with("0::"))
      if (const int n = cores_of_cpu_max(first_line("/sys/fs/cgroup" + line.substr(3) + "/cpu.max")); n > 0) return n;
  if (const int n = cores_of_cpu_max(first_line("/sys/fs/cgroup/cpu.max")); n > 0) return n;
  const std::string quota = first_line("/sys/fs/cgroup/cpu/cpu.cfs_quota_us"), period = first_line("/sys/fs/cgroup/cpu/cpu.cfs_period_us");
  return cores_of_cpu_max(quota + " " + period);
}
}  // namespace

int cores_of_cpu_max(const std::string& cpu_max) {
  std::istringstream in(cpu_max);
  double quota_us = 0, period_us = 0;
  if (!(in >> quota_us >> period_us)) return 0;  // "max 100000": no quota
  return quota_cores(quota_us, period_us);
}

int available_cores() {
  int cores = static_cast<int>(std::thread::hardware_concurrency());
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) == 0) cores = CPU_COUNT(&set);
  const int limit = cgroup_cores();
  if (limit > 0) cores = std::min(cores, limit);
  return std::max(1, cores);
}

std::string cpu_model_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kNever = std::numeric_limits<int>::max();
  ::mallopt(M_MMAP_THRESHOLD, kNever);
  ::mallopt(M_TRIM_THRESHOLD, kNever);
#endif
}

std::uint64_t peak_memory_bytes() {
  struct rusage usage {};
  if (::getrusage(RUSAGE_SELF, &usage) != 0 || usage.ru_maxrss < 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux reports KiB
}
}  // namespace venato
