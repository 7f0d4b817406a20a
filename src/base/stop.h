#ifndef HINDSIGHT_BASE_STOP_H_
#define HINDSIGHT_BASE_STOP_H_

#include <atomic>

namespace hindsight {

/// Asks whatever the process is at to stop. May be called by a signal handler.
void RequestStop();

/// True from RequestStop() on.
const std::atomic<bool>& StopRequested();

/// Throws Interrupted if a stop was requested. Loops over rows of unknown
/// number call it at least every tenth of a second.
void ThrowIfStopRequested();

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_STOP_H_
