#ifndef HINDSIGHT_APP_RUN_ATTITUDE_H_
#define HINDSIGHT_APP_RUN_ATTITUDE_H_

#include "app/run_request.h"

namespace hindsight {

/// `hindsight run` with methods for attitude alone: loads, estimates, writes,
/// prints. Returns the exit status.
int EstimateAttitude(const RunRequest& request);

}  // namespace hindsight

#endif  // HINDSIGHT_APP_RUN_ATTITUDE_H_
