#ifndef HINDSIGHT_RECEIVER_ERRORS_ERROR_TUNING_H_
#define HINDSIGHT_RECEIVER_ERRORS_ERROR_TUNING_H_

#include <vector>

#include "receiver_errors/mode_sequence.h"
#include "receiver_errors/search_effort.h"
#include "receiver_errors/tunable_parameters.h"
#include "state/solution.h"

namespace hindsight {

/// The parameters that maximise the likelihood of a sequence's fixes times their
/// prior, from `from` on: scale, share and ratio of outliers, the factor on the
/// IMU's noise and, where the sequence has them, sigmas and correlation times of
/// biases and the sigma of rates. The prior is normal in the logarithm of each:
///   scale        1, a factor of 2 (a sigma that a receiver states is right to
///                about that); sought within 0.1 to 100
///   IMU          1, a factor of 3 (stated is the noise of an IMU at rest, to
///                which vibration adds, or that of the vibration, which integrates
///                to less); sought within 0.01 to 100, from 1 on where the
///                sensor errs throughout in several parts
///   outliers     2 % of 10 times the sigma, a factor of 4.5 each
///   slight bias  as `from` says, a factor of 2.7
///   bias down    that of the other axes, a factor of 3; of a sequence with one
///                bias and no other error, else the same
///   the rest     as `from` says, a factor of 10
///
/// A fix is a mixture of two normal densities about the innovation, inlier and
/// outlier, whose covariances have the uncertainty of the trajectory in them:
/// expectation-maximisation has no closed maximisation step then, and the same
/// maximum is found by a search, parameter by parameter in the logarithm, to a
/// factor of 1.08 for the scale and of 1.3 for the rest.
ErrorParameters TuneParameters(const SensorTape& tape,
                               const ModeSequence& sequence,
                               const ErrorParameters& from,
                               SearchEffort* effort = nullptr);

/// The same of scale, share and ratio of outliers alone, to a factor of 1.3: what
/// differs between fixes and their normal points. The scale is sought from
/// `least_scale` on.
ErrorParameters TuneNoise(const SensorTape& tape, const ModeSequence& sequence,
                          const ErrorParameters& from, double least_scale,
                          SearchEffort* effort = nullptr);

/// ln of that prior but for constants, `typical` being what the search began
/// from.
double LogPriorOf(const ModeSequence& sequence, const ErrorParameters& p,
                  const ErrorParameters& typical);

/// ln of the integral over the parameters of likelihood times prior, by likelihood times
/// prior at `found`, the prior being that of LogPriorOf, normalised: Laplace's approximation (MacKay,
/// Information Theory, Inference, and Learning Algorithms, 27), of each parameter by
/// itself. A parameter of which the data say nothing adds nothing, others take
/// ln of the ratio of their posterior sigma to that a priori. The scale is
/// integrated from `least_scale` on.
double LogShareOfPrior(const SensorTape& tape, const ModeSequence& sequence,
                       const ErrorParameters& found,
                       const ErrorParameters& typical,
                       double least_scale = kLeastScale,
                       SearchEffort* effort = nullptr);

/// What LogShareOfPrior is at the most: of data that say nothing, where the prior has
/// its top at a bound.
double MostOfLogShare(const ModeSequence& sequence,
                      const ErrorParameters& typical,
                      double least_scale = kLeastScale);

/// The parameters of a sequence that TuneParameters seeks within bounds which
/// mean something: a share of outliers may be as small as it likes, and the noise of
/// the IMU, a bias last for ever, and a stated sigma have as small a factor as it likes
/// where that is said: of a tolerance, and on all fixes.
std::vector<BoundedValue> BoundedParameters(const ModeSequence& sequence,
                                            const ErrorParameters& found,
                                            bool any_least_scale);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_ERROR_TUNING_H_
