#ifndef HINDSIGHT_APP_INTERRUPT_H_
#define HINDSIGHT_APP_INTERRUPT_H_

#include <atomic>

namespace hindsight {

/// From now on SIGINT and SIGTERM set StopRequested() instead of ending the
/// process.
void CatchInterrupts();

/// Becomes true when the user has asked to stop.
const std::atomic<bool>& StopRequested();

/// Throws Interrupted if the user has asked to stop.
void ThrowIfStopRequested();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_INTERRUPT_H_
