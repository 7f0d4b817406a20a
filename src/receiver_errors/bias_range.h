#ifndef HINDSIGHT_RECEIVER_ERRORS_BIAS_RANGE_H_
#define HINDSIGHT_RECEIVER_ERRORS_BIAS_RANGE_H_

#include <optional>

#include "receiver_errors/mode_sequence.h"
#include "receiver_errors/search_effort.h"

namespace hindsight {

/// What the data tell of a bias that lasts, were it of the size of what is stated: with the
/// prior of a slight one. A stated sigma has slow errors in it.
struct SlightBias {
  ErrorParameters expected;  ///< as BiasRange::expected
  double log_gain = 0.0;     ///< ln of the evidence over that as a bias
};

/// What the data tell of a bias that lasts.
struct BiasRange {
  ErrorParameters likeliest;
  /// With the means of ln sigma and ln tau a posteriori. The mean square hangs on what is
  /// least likely of all, the far end of the ridge, and takes from fixes what they tell.
  ErrorParameters mean;
  /// Of which the mean of the bias over the recording has the variance (VarianceOfMean)
  /// that is expected a posteriori, with the mean of ln tau by what each adds to it. Where
  /// nothing else tells positions that mean is what nobody sees: covariances of `mean`
  /// would be too small by as much as is left open.
  ErrorParameters expected;
  /// None where the effort was spent before the posterior was followed to its end.
  std::optional<SlightBias> slight = std::nullopt;
  /// ln of the integral of the posterior over sigma and tau, by what LogShareOfPrior takes
  /// it for at `likeliest`, of each by itself.
  double log_gain = 0.0;
};

/// Of an error that changes slowly only 2 sigma^2 / tau is seen, its walk over short
/// times: what is slower the IMU's biases and the start take up, so that sigma and tau
/// may both be much larger, and the noise of the IMU the smaller the more of what is slow
/// is the sensor's. `found` is followed along that ridge, by factors of four of tau each
/// with its likeliest sigma, sigma down and factor on that noise, and across it, in sigma
/// alone, to where odds are a thousand against it: of an error that noise hides the
/// posterior is no ridge, but falls off where sigma is too large.
BiasRange FollowBias(const SensorTape& tape, const ModeSequence& sequence,
                     const ErrorParameters& found, const ErrorParameters& from,
                     SearchEffort* effort = nullptr);

/// Of the mean over so many seconds of a Gauss-Markov process [m^2]:
/// 2 sigma^2 tau / T (1 - tau / T (1 - exp(-T / tau))) (Papoulis, Probability, Random
/// Variables, and Stochastic Processes, on ergodicity of the mean).
double VarianceOfMean(const ErrorParameters& p, double duration);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_BIAS_RANGE_H_
