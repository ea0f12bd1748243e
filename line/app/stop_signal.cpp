#include "line/app/stop_signal.h"

#include <csignal>
namespace venato::line::app {
namespace {
std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "used in a signal handler");

extern "C" void on_stop_signal(int signal_number) {
  if (stop.exchange(true)) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
  }
}
}  // namespace

const std::atomic<bool>& stop_flag() { return stop; }

void watch_stop_signals() {
  std::signal(SIGINT, on_stop_signal);
  std::signal(SIGTERM, on_stop_signal);
}
}  // namespace venato::line::app
