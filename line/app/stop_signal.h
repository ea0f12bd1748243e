#pragma once
#include <atomic>
namespace venato::line::app {
/// Set by the first SIGINT or SIGTERM: long work stops at its next safe point. A second signal ends the process at once.
const std::atomic<bool>& stop_flag();
void watch_stop_signals();
}  // namespace venato::line::app
