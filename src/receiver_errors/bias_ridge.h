#ifndef HINDSIGHT_RECEIVER_ERRORS_BIAS_RIDGE_H_
#define HINDSIGHT_RECEIVER_ERRORS_BIAS_RIDGE_H_

#include "receiver_errors/mode_sequence.h"
#include "receiver_errors/search_effort.h"

namespace hindsight {

/// What the data tell of a bias that lasts.
struct BiasRange {
  ErrorParameters likeliest;
  /// With the mean of ln sigma a posteriori, and the likeliest tau of it. The mean
  /// square hangs on what is least likely of all, the far end of the ridge, and takes
  /// from fixes what they tell.
  ErrorParameters mean;
  /// ln of the integral of the posterior over tau along the ridge, by what
  /// LogShareOfPrior takes it for at fixed sigma.
  double log_gain = 0.0;
};

/// Of an error that changes slowly only 2 sigma^2 / tau is seen, its walk over short
/// times: what is slower the IMU's biases and the start take up, so that sigma and tau
/// may both be much larger. `found` is followed along that ridge, by factors of two of
/// tau each with its likeliest sigma, to where odds are a thousand against it.
BiasRange FollowBias(const SensorTape& tape, const ModeSequence& sequence,
                     const ErrorParameters& found, const ErrorParameters& from,
                     SearchEffort* effort = nullptr);

}  // namespace hindsight

#endif  // HINDSIGHT_RECEIVER_ERRORS_BIAS_RIDGE_H_
