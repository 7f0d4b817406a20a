#ifndef HINDSIGHT_RECEIVER_ERRORS_SWITCHING_REGIMES_H_
#define HINDSIGHT_RECEIVER_ERRORS_SWITCHING_REGIMES_H_

#include <vector>

#include "receiver_errors/error_regimes.h"
#include "receiver_errors/error_tuning.h"

namespace hindsight {

/// The last of FitRegimes: of every order of modes that is found, from what was met before
/// and from attempts with errors of several sizes about `start`, and of what else its jumps
/// and outliers may be, a fit with parameters of its own. `white` is what white noise makes
/// of the same fixes. None where no error is found.
std::vector<ErrorRegimes> FitSwitching(const RegimeProblem& problem,
                                       const ErrorParameters& start,
                                       const ErrorRegimes& white);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_SWITCHING_REGIMES_H_
