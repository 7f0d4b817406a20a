#ifndef HINDSIGHT_DATASET_TRUTH_START_H_
#define HINDSIGHT_DATASET_TRUTH_START_H_

#include "dataset/dataset.h"

namespace hindsight {

/// Gives `initial` the time, position, velocity and attitude that it lacks:
/// those of the first point of the truth inside the IMU's record and not before
/// initial.t. Position and velocity are the IMU's, less the truth's lever arm
/// and the turn about it (by the gyros). Throws InputError if no point has all
/// three.
void StartFromTruth(Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_TRUTH_START_H_
