#ifndef HINDSIGHT_ALIGNMENT_ATTITUDE_REST_H_
#define HINDSIGHT_ALIGNMENT_ATTITUDE_REST_H_

#include <vector>

#include "attitude/attitude_state.h"
#include "dataset/dataset.h"

namespace hindsight {

/// Whether the body rests from each sample of `imu` to the next, by the whole
/// recording (FindRest, thresholds of `stationary`). A steady turn is as quiet
/// as rest: the mean rate of a span must be one that the bias of `start`
/// explains, to three sigmas.
std::vector<bool> RestsBetweenSamples(const Dataset& dataset,
                                      const ImuStream& imu,
                                      const AttitudeState& start);

}  // namespace hindsight

#endif  // HINDSIGHT_ALIGNMENT_ATTITUDE_REST_H_
