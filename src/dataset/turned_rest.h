#ifndef HINDSIGHT_DATASET_TURNED_REST_H_
#define HINDSIGHT_DATASET_TURNED_REST_H_

#include "dataset/rest.h"

namespace hindsight {

/// Moves to `turning` what turns so steadily that over no window it differs
/// from a gyro bias: at rest all read the same bias. Two rests contradict each
/// other where, on any axis and by more than five sigmas, their mean rates
/// differ, against StationaryOptions::rate_sigma, white noise and the stated walk
/// of the bias, and the rates over the 2 s with which they face each other as
/// well, against a walk of at least an a priori sigma in a minute, as of gyros
/// that warm up. From the rest nearest to the given bias on, those stay that
/// contradict none that stays; and none if the a priori bias does not tell them
/// from those that go by odds of 150 to 1. Where a rest's two halves contradict
/// each other the gyros drift, and nothing is taken out.
void LeaveOutTurned(const Dataset& dataset, Rest* rest);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_TURNED_REST_H_
