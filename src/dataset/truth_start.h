#ifndef HINDSIGHT_DATASET_TRUTH_START_H_
#define HINDSIGHT_DATASET_TRUTH_START_H_

#include <optional>

#include "dataset/dataset.h"

namespace hindsight {

/// Offset of a truth's stamps from the IMU's clock.
struct TruthClock {
  double offset = 0.0;  ///< added to the stamps [s]
  double sigma = 0.0;   ///< [s]
};

/// The offset, at most 2 s either way, at which the turns from one attitude of
/// the truth to the next fit best the integrated gyros, in the least squares of
///   Log(R_truth^T R_gyro) - mean,
/// the mean being what a constant bias leaves; the Earth's rate is allowed for
/// where the truth has positions. Nothing if the truth does not turn enough to
/// tell it to 20 ms, no offset inside the range is best, or the best leaves
/// more than a quarter of the mean square that the range has on average.
std::optional<TruthClock> FindTruthClock(const ImuStream& imu,
                                         const std::vector<TruthPoint>& truth);

/// Gives `initial` the time, position, velocity and attitude that it lacks:
/// those of the first point of the truth inside the IMU's record and not before
/// initial.t. Position and velocity are the IMU's, less the truth's lever arm
/// and the turn about it (by the gyros). Throws InputError if no point has all
/// three.
void StartFromTruth(Dataset* dataset);

}  // namespace hindsight

#endif  // HINDSIGHT_DATASET_TRUTH_START_H_
