#include "base/stop.h"

#include "base/error.h"

namespace hindsight {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

}  // namespace

void RequestStop() { stop_requested = true; }

const std::atomic<bool>& StopRequested() { return stop_requested; }

void ThrowIfStopRequested() {
  if (stop_requested) throw Interrupted();
}

}  // namespace hindsight
