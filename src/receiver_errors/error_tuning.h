#ifndef HINDSIGHT_RECEIVER_ERRORS_ERROR_TUNING_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERROR_TUNING_H_

#include <vector>

#include "receiver_errors/error_history.h"
#include "state/solution.h"

namespace hindsight {

/// The parameters that maximise the likelihood of a history's fixes times their
/// prior, from `from` on: scale, share and ratio of outliers, and, where the
/// history has them, sigmas and taus of biases and the sigma of rates. The
/// prior is normal in the logarithm of each, so weak that it only keeps what
/// the data do not show.
///
/// A fix is a mixture of two normal densities about the innovation, inlier and
/// outlier, whose covariances have the uncertainty of the trajectory in them:
/// expectation-maximisation has no closed maximisation step then, and the same
/// maximum is found by a search, parameter by parameter in the logarithm, to a
/// factor of 1.08 for the scale and of 1.3 for the rest.
ErrorParameters TuneParameters(const LinearTape& tape, int receiver,
                               const ErrorHistory& history,
                               const ErrorParameters& from);

/// The parameters of a history that TuneParameters seeks within bounds which
/// mean something: a share of outliers may be as small as it likes, and a bias
/// last for ever.
std::vector<BoundedValue> BoundedParameters(const ErrorHistory& history,
                                            const ErrorParameters& found);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERROR_TUNING_H_
