#pragma once
#include <atomic>
#include <cstdint>
#include "base/progress.h"
namespace venato {
class Store;

/// What every long computation gets besides its inputs. Owned by the command line; nothing here changes results:
/// the same inputs and seed give the same bytes whatever log, progress, threads or store are.
struct Context {
  Log& log;
  Progress& progress;
  Store& store;
  std::uint64_t seed = 0;
  int threads = 1;                          ///< OpenMP threads to use (>= 1)
  const std::atomic<bool>* stop = nullptr;  ///< set by SIGINT/SIGTERM; long loops checkpoint and throw Interrupted
  bool stop_requested() const { return stop && stop->load(std::memory_order_relaxed); }
};
}  // namespace venato
