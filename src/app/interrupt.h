#ifndef HINDSIGHT_APP_INTERRUPT_H_
#define HINDSIGHT_APP_INTERRUPT_H_

#include "base/stop.h"

namespace hindsight {

/// From now on SIGINT and SIGTERM request a stop (base/stop.h) instead of
/// ending the process.
void CatchInterrupts();

}  // namespace hindsight

#endif  // HINDSIGHT_APP_INTERRUPT_H_
