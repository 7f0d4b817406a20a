#include "app/interrupt.h"

#include <csignal>

#include "base/error.h"

namespace hindsight {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

void RequestStop(int) { stop_requested = true; }

}  // namespace

void CatchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = RequestStop;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const std::atomic<bool>& StopRequested() { return stop_requested; }

void ThrowIfStopRequested() {
  if (stop_requested) throw Interrupted();
}

}  // namespace hindsight
