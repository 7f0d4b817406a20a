#ifndef HINDSIGHT_RECEIVER_ERRORS_UNIFORM_REGIMES_H_
#define HINDSIGHT_RECEIVER_ERRORS_UNIFORM_REGIMES_H_

#include <limits>
#include <vector>

#include "receiver_errors/error_regimes.h"
#include "receiver_errors/error_tuning.h"

namespace hindsight {

/// A factor on the noise of the IMU beyond which what the search took for errors
/// of the sensor may be the IMU's: two sigmas of what is stated of it.
inline constexpr double kMisstatedImu = 2.0;

/// The least factor on the stated sigma that fixes get in the batch: a stated
/// sigma has slow errors in it that fixes close to each other do not show, so
/// that a small scatter is no reason to believe them more than stated.
inline constexpr double kLeastSolved = 1.0;

/// Whether the batch can be solved with white errors as they were fitted.
bool CanBeSolved(const ErrorParameters& white);

/// Stated and white, the first of FitRegimes: of all fixes behind normal points,
/// which do not hold the outliers among them. Where they cannot be solved with
/// (CanBeSolved), and so do not stand, they are there a second time as they can be:
/// with the IMU as stated and a scale of kLeastSolved or more.
std::vector<ErrorRegimes> FitNoise(const RegimeProblem& problem);

/// A Gauss-Markov error of all fixes, parameters sought `from` on. Evidence that cannot
/// exceed `worth` is told as what it cannot exceed.
ErrorRegimes FitGaussMarkov(
    const RegimeProblem& problem, const ErrorParameters& from,
    double worth = -std::numeric_limits<double>::infinity());

/// ln of the evidence of a fit of any kind whose parameters were sought `from` on,
/// the scale from `least_scale` on (ErrorRegimes::log_evidence).
double LogEvidenceOf(const RegimeProblem& problem, const Hypothesis& best,
                     const ErrorParameters& from,
                     double least_scale = kLeastScale);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_UNIFORM_REGIMES_H_
