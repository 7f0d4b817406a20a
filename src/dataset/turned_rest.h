#ifndef HINDSIGHT_DATASET_TURNED_REST_H_
#define HINDSIGHT_DATASET_TURNED_REST_H_

#include "dataset/rest.h"

namespace hindsight {

/// Moves to `turning` what turns so steadily that over no window it differs
/// from a gyro bias: at rest all read the same bias. Two rests contradict each
/// other where their mean rates differ, on any axis, by more than five sigmas
/// of StationaryOptions::rate_sigma, white noise and bias walk between them; of
/// rests that do, those stay that agree with the one nearest to the given bias,
/// and none if the a priori bias does not tell them from those that go by odds
/// of 150 to 1. Where a rest's two halves contradict each other the gyros
/// drift, and nothing is taken out.
void LeaveOutTurned(const Dataset& dataset, Rest* rest);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_TURNED_REST_H_
