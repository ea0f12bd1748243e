#pragma once
#include <cstdint>
#include <string>
namespace venato {
/// Cores this process may really use: CPU affinity (taskset, Slurm) cut by the control group's quota (containers), >= 1.
int available_cores();
/// Model name of the first CPU, e.g. "AMD EPYC 7763 64-Core Processor"; "unknown" where the system does not tell.
std::string cpu_model_name();
/// Largest resident memory of this process so far [bytes]; 0 where the system does not tell.
std::uint64_t peak_memory_bytes();
/// Freed memory stays with the process for its next use; call first thing in main(). Else every large array is zeroed by the kernel anew: a third of a
/// neighbour list's build at a million grains. Costs what fragments lie free at the peak (measured there: 4 %). Without effect outside glibc.
void keep_freed_memory();
/// Whole-number cores of a cgroup v2 "cpu.max" text ("max 100000", "150000 100000" -> 2), 0 = no limit. For tests and available_cores().
int cores_of_cpu_max(const std::string& cpu_max);
}  // namespace venato
