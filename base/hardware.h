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
/// Whole-number cores of a cgroup v2 "cpu.max" text ("max 100000", "150000 100000" -> 2), 0 = no limit. For tests and available_cores().
int cores_of_cpu_max(const std::string& cpu_max);
}  // namespace venato
