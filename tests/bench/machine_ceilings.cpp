/// What this machine can do at most, on one core and on all: memory and cache bandwidth, double FMA, division, square root with the widest SIMD of
/// the CPU.
///   machine_ceilings [THREADS]
/// The roof that a DEM step is compared with (tests/bench/RESULTS.md). Best of several repeats: a ceiling, not a mean.
#include <immintrin.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base/hardware.h"

namespace venato::bench {
namespace {
struct Kernels {
  int lanes;
  double (*fma)(long), (*div)(long), (*sqrt)(long);
  double (*read)(const double*, long);
  void (*copy)(double*, const double*, long);
  void (*triad)(double*, const double*, const double*, long);
};
}  // namespace

// g++ 12 warns of the undefined operand inside its own _mm512_sqrt_pd.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")
namespace wide {
namespace {
#define VENATO_LANES 8
#define VENATO_SQRT(v) ((Lanes)_mm512_sqrt_pd((__m512d)(v)))
#include "tests/bench/ceiling_kernels.inc"
#undef VENATO_LANES
#undef VENATO_SQRT
}  // namespace
}  // namespace wide
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx2,fma")
namespace middle {
namespace {
#define VENATO_LANES 4
#define VENATO_SQRT(v) ((Lanes)_mm256_sqrt_pd((__m256d)(v)))
#include "tests/bench/ceiling_kernels.inc"
#undef VENATO_LANES
#undef VENATO_SQRT
}  // namespace
}  // namespace middle
#pragma GCC pop_options

namespace narrow {
namespace {
#define VENATO_LANES 2
#define VENATO_SQRT(v) ((Lanes)_mm_sqrt_pd((__m128d)(v)))
#include "tests/bench/ceiling_kernels.inc"
#undef VENATO_LANES
#undef VENATO_SQRT
}  // namespace
}  // namespace narrow

namespace {
constexpr long kBlock = 64;                        // doubles: every kernel's unroll divides it
constexpr std::size_t kArrayBytes = 512ull << 20;  // three of them: beyond any last-level cache in use
constexpr double kLeastSeconds = 0.05;             // per timed run, so that starting threads does not count
constexpr int kRepeats = 7;

volatile double sink;  // keeps results alive

const Kernels& best_kernels() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) return wide::kKernels;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return middle::kKernels;
  return narrow::kKernels;
}

/// Wall-clock seconds of work(thread) on all threads at once, from the common start to the last one's end.
template <class Work>
double seconds_together(int threads, const Work& work) {
  std::vector<double> result(static_cast<std::size_t>(threads) * 8);
  std::chrono::steady_clock::time_point from, to;
#pragma omp parallel num_threads(threads)
  {
    const int t = omp_get_thread_num();
#pragma omp barrier
#pragma omp master
    from = std::chrono::steady_clock::now();
    result[static_cast<std::size_t>(t) * 8] = work(t);
#pragma omp barrier
#pragma omp master
    to = std::chrono::steady_clock::now();
  }
  for (const double r : result) sink = sink + r;
  return std::chrono::duration<double>(to - from).count();
}

/// Largest amount(n) per second over the repeats; n grows until a run is long enough to time.
template <class Work>
double best_rate(int threads, double amount_per_round, const Work& work) {
  long rounds = 1;
  while (seconds_together(threads, [&](int t) { return work(t, rounds); }) < kLeastSeconds) rounds *= 2;
  double best = 0;
  for (int k = 0; k < kRepeats; ++k)
    best = std::max(best, amount_per_round * static_cast<double>(rounds) / seconds_together(threads, [&](int t) { return work(t, rounds); }));
  return best;
}

double arithmetic_rate(int threads, const Kernels& k, double (*run)(long)) {
  constexpr long kInner = 1000;
  return best_rate(threads, static_cast<double>(kInner) * narrow::kChains * k.lanes * threads,
                   [&](int, long rounds) { return run(kInner * rounds); });
}

using Buffer = std::unique_ptr<double, void (*)(void*)>;
Buffer buffer(std::size_t doubles) {
  void* p = std::aligned_alloc(4096, (doubles * sizeof(double) + 4095) / 4096 * 4096);
  if (!p) {
    std::fprintf(stderr, "machine_ceilings: not enough memory for %zu MiB\n", doubles * sizeof(double) >> 20);
    std::exit(1);
  }
  return Buffer(static_cast<double*>(p), &std::free);
}

/// Each thread reads its own `bytes` again and again. \return [byte/s]
double cache_rate(int threads, const Kernels& k, double bytes) {
  const long n = std::max(kBlock, static_cast<long>(bytes / sizeof(double)) / kBlock * kBlock);
  std::vector<Buffer> own;
  for (int t = 0; t < threads; ++t) own.push_back(buffer(static_cast<std::size_t>(n)));
  seconds_together(threads, [&](int t) { return std::fill_n(own[static_cast<std::size_t>(t)].get(), n, 1e-9) ? 0.0 : 1.0; });
  return best_rate(threads, static_cast<double>(n) * sizeof(double) * threads, [&](int t, long rounds) {
    double sum = 0;
    for (long r = 0; r < rounds; ++r) sum += k.read(own[static_cast<std::size_t>(t)].get(), n);
    return sum;
  });
}

struct MemoryRates {
  double read, copy, triad;
};
MemoryRates memory_rates(int threads, const Kernels& k) {
  const long n = static_cast<long>(kArrayBytes / sizeof(double)) / (kBlock * threads) * (kBlock * threads), part = n / threads;
  const Buffer x = buffer(static_cast<std::size_t>(n)), y = buffer(static_cast<std::size_t>(n)), z = buffer(static_cast<std::size_t>(n));
  seconds_together(threads, [&](int t) {  // first touch by the thread that works on it
    for (double* a : {x.get(), y.get(), z.get()}) std::fill_n(a + t * part, part, 1e-9);
    return 0.0;
  });
  const double array = static_cast<double>(n) * sizeof(double);
  const auto times = [&](long rounds, const auto& once) {
    double sum = 0;
    for (long r = 0; r < rounds; ++r) sum += once();
    return sum;
  };
  MemoryRates rates{};
  rates.read = best_rate(threads, array, [&](int t, long m) { return times(m, [&] { return k.read(x.get() + t * part, part); }); });
  rates.copy = best_rate(threads, 2 * array, [&](int t, long m) {
    return times(m, [&] { return k.copy(x.get() + t * part, y.get() + t * part, part), x.get()[t * part]; });
  });
  rates.triad = best_rate(threads, 3 * array, [&](int t, long m) {
    return times(m, [&] { return k.triad(x.get() + t * part, y.get() + t * part, z.get() + t * part, part), x.get()[t * part]; });
  });
  return rates;
}

/// Size of the data cache of a level that the first core sees. The system's table knows the share of a virtual machine, sysconf only the real chip's.
double cache_bytes(int level, double assumed) {
  for (int index = 0; index < 8; ++index) {
    const std::string folder = "/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(index) + "/";
    std::string type;
    double found_level = 0, kib = 0;
    std::ifstream(folder + "type") >> type;
    std::ifstream(folder + "level") >> found_level;
    if (type != "Instruction" && found_level == level && std::ifstream(folder + "size") >> kib && kib > 0) return kib * 1024;
  }
  std::printf("L%d: size unknown, %.0f KiB assumed\n", level, assumed / 1024);
  return assumed;
}

void print(const char* what, double one, double all, double unit, const char* unit_name) {
  std::printf("%-34s %12.2f %12.2f  %s\n", what, one / unit, all / unit, unit_name);
}

void run(int threads) {
  const Kernels& k = best_kernels();
  const double l2 = cache_bytes(2, 1 << 20), l3 = cache_bytes(3, 16 << 20);
  std::printf("cpu %s, %d threads, %d doubles per register, L2 %.2f MiB, L3 %.0f MiB\n", cpu_model_name().c_str(), threads, k.lanes, l2 / 1048576,
              l3 / 1048576);
  std::printf("%-34s %12s %12s\n", "ceiling", "1 thread", "all threads");
  const MemoryRates one = memory_rates(1, k), all = memory_rates(threads, k);
  print("memory read", one.read, all.read, 1e9, "GB/s");
  print("memory copy (read + written)", one.copy, all.copy, 1e9, "GB/s");
  print("memory triad (2 read + written)", one.triad, all.triad, 1e9, "GB/s");
  // Half of a cache, so that nothing else evicts it; L3 is shared by the threads and must be far more than their L2.
  print("L2 read", cache_rate(1, k, l2 / 2), cache_rate(threads, k, l2 / 2), 1e9, "GB/s");
  const double l3_one = std::max(l3 / 2, 3 * l2), l3_all = std::max(l3 / 2 / threads, 3 * l2);
  print("L3 read", cache_rate(1, k, l3_one), cache_rate(threads, k, l3_all), 1e9, "GB/s");
  print("FMA (double)", arithmetic_rate(1, k, k.fma), arithmetic_rate(threads, k, k.fma), 1e9, "G per s (2 flop each)");
  print("division (double)", arithmetic_rate(1, k, k.div), arithmetic_rate(threads, k, k.div), 1e9, "G per s");
  print("square root (double)", arithmetic_rate(1, k, k.sqrt), arithmetic_rate(threads, k, k.sqrt), 1e9, "G per s");
}
}  // namespace
}  // namespace venato::bench

int main(int argc, char** argv) {
  int threads = venato::available_cores();
  if (argc == 2) threads = std::atoi(argv[1]);
  if (argc > 2 || threads < 1 || threads > 4096) {
    std::fprintf(stderr, "usage: machine_ceilings [THREADS]\n");
    return 2;
  }
  venato::bench::run(threads);
}
